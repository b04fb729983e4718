#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""Prints "POINTS IMU FRAME DOMAIN": three ports free for UDP and TCP and a DDS domain that nobody on this machine
uses, so that several demos run side by side."""
import os
import socket
import sys


def is_free(port, kind, address="127.0.0.1"):
    with socket.socket(socket.AF_INET, kind) as candidate:
        try:
            candidate.bind((address, port))
        except OSError:
            return False
    return True


def free_ports(count):
    # Below Linux' range of ephemeral ports (32768 and up), at a place of its own for each process.
    start = 20000 + os.getpid() * 7 % 10000
    ports = (p for p in range(start, 32000)
             if is_free(p, socket.SOCK_DGRAM) and is_free(p, socket.SOCK_STREAM))
    return [next(ports) for _ in range(count)]


def free_domain():
    # RTPS 9.6.1.1: domain d listens at 7400 + 250 d, its participants from 10 above.
    for step in range(90):
        domain = 1 + (os.getpid() + step) % 90
        if all(is_free(7400 + 250 * domain + offset, socket.SOCK_DGRAM, "0.0.0.0") for offset in (0, 1, 10, 11, 12, 13)):
            return domain
    sys.exit("no free DDS domain: are 90 demos running?")


print(*free_ports(3), free_domain())
