// SPDX-License-Identifier: Apache-2.0
// The libraries of takt are compiled as for an executable (-fPIE), which reaches this flag of the C library directly; a
// module may not. Its own copy says what is always right: there may be threads, so counts of references are changed
// atomically.
extern "C" {
extern char __libc_single_threaded;
char __libc_single_threaded = 0;
}
