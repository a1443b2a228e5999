// SPDX-License-Identifier: Apache-2.0
// Where large networks lie in memory.
#pragma once

namespace takt::scenario {

/// Asks the system to put what is allocated from now on onto huge pages (2 MiB), as far as it comes from the heap of
/// the main thread and up to 1 GiB. Every hop of a large network touches a port, a stream and a frame somewhere else;
/// with pages of 4 KiB nearly each such touch costs a walk through the page tables as well. Memory is taken up in steps
/// of 2 MiB then and stays with the process; where the system has no such pages, in small ones as ever. Nothing happens
/// where another library allocates, or the process may only have so much address space. To be called before anything
/// large is allocated, by programs that simulate one network.
void put_heap_on_huge_pages();

}  // namespace takt::scenario
