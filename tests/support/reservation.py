# SPDX-License-Identifier: Apache-2.0
"""Domains and ports that belong to one test program, so that tests at the same time do not meet: reservation.hpp for tests in Python."""
import os
import socket

PORTS_IN_BLOCK = 19
_held = []  # until the program ends


def _reserve(count, holder_of):
    for i in range(count):
        candidate = (os.getpid() + i) % count
        holder = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            holder.bind(("127.0.0.1", holder_of(candidate)))
        except OSError:
            holder.close()
            continue
        _held.append(holder)
        return candidate
    raise RuntimeError("all domains or ports for tests are taken")


def domain():
    """A DDS domain from 1 to 80."""
    return 1 + _reserve(80, lambda candidate: 7400 + 250 * (1 + candidate) + 10 + 2 * 100)


def ports():
    """The first of PORTS_IN_BLOCK UDP ports."""
    return 28_000 + (PORTS_IN_BLOCK + 1) * _reserve(200, lambda candidate: 28_000 + (PORTS_IN_BLOCK + 1) * candidate + PORTS_IN_BLOCK)
