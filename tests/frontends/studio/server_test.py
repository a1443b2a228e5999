#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""takt studio lets nobody in who has not its address: foreign origins, other names, wrong tokens, huge and broken bodies; and a killed engine loses no text.

  server_test.py TAKT SOURCE
"""
import http.client
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest


class Studio:
    """A running `takt studio` on a scenario of a folder of its own."""

    def __init__(self, folder, name="plant.json"):
        self.file = folder / name
        self.process = subprocess.Popen([TAKT, "studio", self.file], stdout=subprocess.PIPE, text=True)
        address = self.process.stdout.readline().strip()
        found = re.fullmatch(r"http://127\.0\.0\.1:(\d+)/\?token=([0-9a-f]{32})", address)
        assert found, address
        self.port, self.token = int(found.group(1)), found.group(2)

    def ask(self, method, path, body=None, **headers):
        """Status and body; `token=None` sends none."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        sent = {"X-Takt-Token": self.token} | {name.replace("_", "-"): value for name, value in headers.items()}
        connection.request(method, path, body=body, headers={name: value for name, value in sent.items() if value is not None})
        response = connection.getresponse()
        answer = response.status, response.read().decode(), dict(response.getheaders())
        connection.close()
        return answer

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        status = self.process.wait(60)
        self.process.stdout.close()
        return status


class ServerTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        shutil.copy(SOURCE / "scenarios" / "direct-link.json", self.folder / "plant.json")
        self.studio = Studio(self.folder)

    def tearDown(self):
        if self.studio.process.poll() is None:
            self.assertEqual(self.studio.stop(), 0)
        shutil.rmtree(self.folder)

    def test_silent_connections_keep_nobody_waiting(self):
        # With few threads an answer came when most of the silent ones had been closed.
        # A machine that stalls may try again.
        def still_open():
            silent = [socket.create_connection(("127.0.0.1", self.studio.port)) for _ in range(64)]
            self.assertEqual(self.studio.ask("GET", "/api/file")[0], 200)
            count = sum(self.is_open(each) for each in silent)
            for each in silent:
                each.close()
            return count
        self.assertTrue(any(still_open() > 32 for _ in range(5)))

    @staticmethod
    def is_open(connection):
        connection.setblocking(False)
        try:
            return connection.recv(1, socket.MSG_PEEK) != b""
        except BlockingIOError:
            return True
        except OSError:
            return False

    def test_a_browser_is_given_a_page_and_not_the_token(self):
        seen = self.folder / "seen"
        tools = self.folder / "tools"
        tools.mkdir()
        part = f"{seen}.part"
        (tools / "xdg-open").write_text(f'#!/bin/sh\n(stat -c %a "$1"; echo "$@"; cat "$1") > "{part}"\nmv "{part}" "{seen}"\n')
        (tools / "xdg-open").chmod(0o755)
        private = self.folder / "run"
        private.mkdir(mode=0o700)
        environment = os.environ | {"PATH": f"{tools}:{os.environ['PATH']}", "XDG_RUNTIME_DIR": str(private)}
        command = [TAKT, "studio", self.folder / "other.json", "--open"]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment)
        address = process.stdout.readline().strip()
        while not seen.exists():
            self.assertIsNone(process.poll())
            time.sleep(0.05)
        mode, arguments, page = seen.read_text().split("\n", 2)
        self.assertEqual(mode, "600")
        self.assertNotIn(address.split("token=")[1], arguments)
        self.assertIn(f"url={address}", page)
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(60), 0)
        process.stdout.close()
        self.assertEqual(list(private.iterdir()), [])

    def test_the_address_opens_the_page_and_nothing_else_does(self):
        ask, token = self.studio.ask, self.studio.token
        status, body, headers = ask("GET", f"/?token={token}", X_Takt_Token=None)
        self.assertEqual(status, 200)
        self.assertIn("<title>takt studio</title>", body)
        self.assertIn("frame-ancestors 'none'", headers["Content-Security-Policy"])
        self.assertEqual(ask("GET", "/", X_Takt_Token=None)[0], 403)
        self.assertEqual(ask("GET", f"/?token={token[:-1]}", X_Takt_Token=None)[0], 403)
        self.assertEqual(ask("GET", "/api/file", X_Takt_Token=None)[0], 403)
        self.assertEqual(ask("GET", "/api/file", X_Takt_Token="0" * 32)[0], 403)
        self.assertEqual(ask("GET", f"/api/file?token={token}", X_Takt_Token=None)[0], 403)
        self.assertEqual(ask("GET", "/api/file")[0], 200)

    def test_other_origins_and_other_names_are_refused(self):
        ask, port = self.studio.ask, self.studio.port
        self.assertEqual(ask("GET", "/api/file", Origin=f"http://127.0.0.1:{port}")[0], 200)
        for origin in ("http://example.org", "null", f"https://127.0.0.1:{port}", f"http://127.0.0.1:{port + 1}"):
            self.assertEqual(ask("GET", "/api/file", Origin=origin)[0], 403, origin)
        # A name of somebody's that leads to 127.0.0.1.
        for host in (f"example.org:{port}", "127.0.0.1", f"127.0.0.1:{port}.example.org", ""):
            self.assertEqual(ask("GET", "/api/file", Host=host)[0], 403, host)
        self.assertEqual(ask("GET", "/api/file", Host=f"localhost:{port}")[0], 200)

    def test_only_this_machine_is_listened_to(self):
        sockets = subprocess.run(["ss", "-Htln", f"sport = :{self.studio.port}"], capture_output=True, text=True).stdout if shutil.which("ss") else ""
        for line in sockets.splitlines():
            self.assertTrue(line.split()[3].startswith("127.0.0.1:"), line)

    def test_huge_and_broken_requests_disturb_nobody(self):
        self.assertEqual(self.studio.ask("PUT", "/api/text?revision=1", body=b"x" * 9_000_000)[0], 413)
        for octets in (b"\0" * 1000, b"GET / HTTP/1.1\r\n" + b"A: b\r\n" * 10_000 + b"\r\n", b"PUT /api/text HTTP/1.1\r\nContent-Length: 99999999999999999999\r\n\r\n", b"GET " + b"/" * 100_000 + b" HTTP/1.1\r\n\r\n"):
            with socket.create_connection(("127.0.0.1", self.studio.port), timeout=30) as connection:
                try:
                    connection.sendall(octets)
                    connection.shutdown(socket.SHUT_WR)
                    while connection.recv(65536):
                        pass
                except OSError:
                    pass   # it may hang up
        silent = [socket.create_connection(("127.0.0.1", self.studio.port)) for _ in range(3)]   # who says nothing
        self.assertEqual(self.studio.ask("GET", "/api/file")[0], 200)
        for each in silent:
            each.close()
        status, body, _ = self.studio.ask("PUT", "/api/text?revision=2", body=b"\xff\xfe{[")
        self.assertEqual(status, 200)
        while (found := json.loads(self.studio.ask("GET", "/api/findings?after=0")[1]))["stage"] != "refused":
            pass
        self.assertGreater(found["diagnostics"]["errors"], 0)

    def test_absurd_questions_are_refused_or_answered_with_nothing(self):
        ask = self.studio.ask
        text = (self.folder / "plant.json").read_bytes()
        ask("PUT", "/api/text?revision=3", body=text)
        while (found := json.loads(ask("GET", "/api/findings?after=0")[1]))["stage"] != "done" or found["revision"] != 3:
            pass
        huge = "9" * 40
        for question in ("timeline?revision=3&run=" + huge, "timeline?revision=3&from=" + huge, "timeline?revision=" + huge, "timeline?revision=-3", "explain?revision=3&stream=nobody", "explain?revision=3",
                         "explain?revision=3&run=" + huge, "errand?name=../../etc", "errand", "piece?revision=4&level=1&index=1&first=0&count=1"):
            status = ask("GET", "/api/" + question)[0]
            self.assertIn(status, (400, 404, 409), question)
        for question in (f"piece?revision=3&level={huge}&index={huge}&first={huge}&count={huge}", "piece?revision=3&level=-1&index=-1&first=-1&count=-1", "piece?revision=3"):
            self.assertEqual(ask("GET", "/api/" + question)[0], 200, question)
        for name in ("plant.json", "../plant.json", "/etc/passwd", "--out", "", "%00"):
            self.assertEqual(ask("PUT", "/api/study?file=" + name, body=b"")[0], 400, name)
        self.assertEqual(ask("PUT", "/api/layout", body=b"{")[0], 400)
        # Options of a command are words of its own or refused by it; the command line is no shell's.
        self.assertEqual(ask("PUT", "/api/explore?faults=$(touch%20owned)&calls=--out=owned", body=text)[0], 200)
        while (errand := json.loads(ask("GET", "/api/errand?name=explore")[1]))["running"]:
            pass
        self.assertNotEqual(errand["status"], 0)
        self.assertIsNone(errand["output"])
        self.assertEqual(ask("DELETE", "/api/errand?name=explore")[0], 200)
        self.assertEqual(sorted(each.name for each in self.folder.iterdir()), ["plant.json"])

    def test_commands_end_with_the_studio(self):
        self.assertEqual(self.studio.ask("PUT", "/api/explore?faults=loss,crash,restart,timeout,duplicate,reorder&calls=8", body=(SOURCE / "scenarios" / "programs" / "all-to-all.json").read_bytes())[0], 200)
        children = subprocess.run(["pgrep", "-P", str(self.studio.process.pid)], capture_output=True, text=True).stdout.split()
        self.assertEqual(self.studio.stop(), 0)
        for child in children:
            self.assertFalse(pathlib.Path(f"/proc/{child}/exe").exists(), "it goes on without anybody")
        self.assertEqual(sorted(each.name for each in self.folder.iterdir()), ["plant.json"])

    def test_a_killed_engine_loses_no_text(self):
        text = (self.folder / "plant.json").read_text().replace("pair", "twins")
        before = json.loads(self.studio.ask("GET", "/api/file")[1])
        told = json.loads(self.studio.ask("PUT", f"/api/text?revision=5&base={before['digest']}", body=text.encode())[1])
        self.assertEqual(told["problem"], "")
        address = self.studio.port, self.studio.token
        self.studio.process.kill()
        self.studio.process.wait()
        self.studio.process.stdout.close()
        self.studio = Studio(self.folder)
        self.assertEqual((self.studio.port, self.studio.token), address, "pages that are open find the engine that comes after a crash")
        file = json.loads(self.studio.ask("GET", "/api/file")[1])
        self.assertEqual(file["draft"], text)
        self.assertNotEqual(file["saved"], text)
        self.assertFalse(file["draft_is_older"])
        saved = json.loads(self.studio.ask("PUT", f"/api/file?revision=6&base={file['digest']}", body=text.encode())[1])
        self.assertEqual((saved["problem"], saved["conflict"]), ("", False))
        file = json.loads(self.studio.ask("GET", "/api/file")[1])
        self.assertEqual((file["saved"], file["draft"]), (text, None))
        self.assertEqual((self.folder / "plant.json").read_text(), text)

    def test_an_engine_that_ends_in_good_order_leaves_no_token(self):
        token = self.studio.token
        self.assertEqual(self.studio.stop(), 0)
        self.studio = Studio(self.folder)
        self.assertNotEqual(self.studio.token, token)

    def test_a_save_over_another_file_is_refused(self):
        file = json.loads(self.studio.ask("GET", "/api/file")[1])
        (self.folder / "plant.json").write_text("theirs")
        for base in (file["digest"], "", "0" * 16):
            saved = json.loads(self.studio.ask("PUT", f"/api/file?revision=1&base={base}", body=b"mine")[1])
            self.assertTrue(saved["conflict"])
        self.assertEqual((self.folder / "plant.json").read_text(), "theirs")

    def test_a_file_that_is_too_large_is_told(self):
        large = self.folder / "large.json"
        large.write_text(" " * 9_100_000)
        done = subprocess.run([TAKT, "studio", large], capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 2)
        self.assertIn("large.json has 9.1 MB: takt studio takes texts of at most 8 MB", done.stderr)
        large.unlink()
        # Nor one that becomes so while the studio has it.
        (self.folder / "plant.json").write_text(" " * 8_000_001)
        file = json.loads(self.studio.ask("GET", "/api/file")[1])
        self.assertIn("takes texts of at most 8 MB", file["problem"])
        self.assertIsNone(file["saved"])

    # A thousand requirements of a thousand nodes: the worst run of each was kept as a whole scenario, 15 MB.
    def test_many_requirements_of_a_large_network(self):
        many = self.folder / "many.json"
        many.write_text(subprocess.run([sys.executable, SOURCE / "tests/findings/many-requirements.py", "1000"], capture_output=True, text=True, check=True).stdout)
        self.studio.stop()
        self.studio = Studio(self.folder, "many.json")
        self.studio.ask("PUT", "/api/text?revision=1", body=many.read_bytes())
        version = 0
        while True:
            found = json.loads(self.studio.ask("GET", f"/api/findings?after={version}")[1])
            version = found["version"]
            if found["stage"] in ("searching", "done"):
                break
        self.assertEqual(len(found["proofs"]["requirements"]), 1000)
        status = pathlib.Path(f"/proc/{self.studio.process.pid}/status").read_text()
        cpu = sum(map(int, pathlib.Path(f"/proc/{self.studio.process.pid}/stat").read_text().split()[13:15])) / os.sysconf("SC_CLK_TCK")
        megabytes = int(re.search(r"VmHWM:\s*(\d+)", status).group(1)) / 1000
        print(f"1,000 requirements on 1,000 nodes: bounded after {cpu:.2f} s of CPU time, {megabytes:.0f} MB")
        self.assertLess(cpu, 5)
        self.assertLess(megabytes, 400)

    def test_a_port_that_is_taken_is_told(self):
        done = subprocess.run([TAKT, "studio", self.studio.file, "--port", str(self.studio.port)], capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 2)
        self.assertIn("is not to be had", done.stderr)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    TAKT, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
