# SPDX-License-Identifier: Apache-2.0
"""dumpcap on an interface, from before the first frame until after the last one."""
import os
import re
import shutil
import signal
import socket
import struct
import subprocess
import time

PATIENCE = 300  # seconds; what takes longer hangs


class Capture:
    """Why it cannot capture, if `problem` is not empty."""

    def __init__(self, interface, file, capture_filter="", format_option="-n"):
        self.interface, self.file, self.process, self.problem, self.dropped = interface, file, None, "", 0
        self.mark = b"what is captured before this is whole" + os.urandom(16)  # another test may mark the end of its own
        if shutil.which("dumpcap") is None:
            self.problem = "no dumpcap"
            return
        # The kernel keeps 64 MiB for a dumpcap that is not let run.
        command = ["dumpcap", "-q", format_option, "-B", "64", "-i", interface, "-w", str(file)] + (["-f", capture_filter] if capture_filter else [])
        self.process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        said = ""
        for line in self.process.stderr:
            if line.startswith("File:"):
                return
            said += line
        self.process.communicate()
        self.process, self.problem = None, said.strip()

    def end(self):
        """When what was sent before is in the file. Then `dropped` says how many frames the kernel had no room for."""
        until = time.monotonic() + PATIENCE
        while self.mark not in self.file.read_bytes():
            assert time.monotonic() < until, "the capture does not see the mark"
            self.send_mark()
            time.sleep(0.05)
        self.process.send_signal(signal.SIGINT)
        _, said = self.process.communicate(timeout=PATIENCE)
        found = re.search(r"received/dropped on interface.*?: (\d+)/(\d+)", said)
        self.dropped = int(found.group(2)) if found else 0

    def send_mark(self):
        if self.interface == "lo":
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
                sender.sendto(self.mark, ("127.0.0.1", 9))  # discard
            return
        with socket.socket(socket.AF_PACKET, socket.SOCK_RAW) as sender:
            sender.bind((self.interface, 0))
            sender.send(b"\x02\0\0\0\0\1" + b"\x02\0\0\0\0\2" + struct.pack(">H", 0x88B5) + self.mark)  # local experiments

    def kill(self):
        if self.process is not None and self.process.poll() is None:
            self.process.kill()
            self.process.communicate()
