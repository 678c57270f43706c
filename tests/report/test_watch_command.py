"""The page beside a run: to this machine alone, with its token alone, nothing can be changed, and it ends with the run."""
import json
import pathlib
import re
import subprocess
import tempfile
import time
import unittest
import urllib.error
import urllib.request

from support import COMMAND, CONFIGS, PATIENCE, SMALL, call, data_of, simulate


def fetch(address, method="GET"):
    with urllib.request.urlopen(urllib.request.Request(address, method=method), timeout=PATIENCE) as answer:
        return answer.read().decode()


def status_of(address, method="GET"):
    try:
        fetch(address, method)
    except urllib.error.HTTPError as e:
        return e.code
    return 200


class Watch(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = pathlib.Path(self.scratch.name)

    def started(self, *words, stream="stdout"):
        process = subprocess.Popen([COMMAND, *words], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        line = getattr(process, stream).readline()
        return process, re.search(r"http://127\.0\.0\.1:\d+/\?token=[0-9a-f]{32}", line).group(0)

    def test_a_finished_run(self):
        simulate(self.folder)
        process, address = self.started("watch", "out", "--stay")
        (self.folder / "page.html").write_text(fetch(address))
        data = data_of(self.folder / "page.html")
        self.assertTrue(data["live"])
        self.assertEqual(data["sections"][0]["state"], "done")
        self.assertEqual(json.loads(fetch(address.replace("/?", "/data.json?")))["sections"][0]["summary"], data["sections"][0]["summary"])
        self.assertEqual(status_of(address[:-1] + ("0" if address[-1] != "0" else "1")), 403)
        self.assertEqual(status_of(address.split("?")[0]), 403)
        self.assertEqual(status_of(address.replace("/?", "/../summary.json?")), 404)
        for method in ("POST", "PUT", "DELETE"):
            self.assertEqual(status_of(address, method), 405)
        listening = subprocess.run(["sh", "-c", "cat /proc/%d/net/tcp" % process.pid], capture_output=True, text=True).stdout
        port = "%04X" % int(re.search(r":(\d+)/", address).group(1))
        ends = [row.split()[1] for row in listening.splitlines()[1:] if row.split()[3] == "0A" and row.split()[1].endswith(":" + port)]
        self.assertEqual(ends, ["0100007F:" + port])
        process.terminate()
        self.assertEqual(process.wait(timeout=PATIENCE), 0)

    def test_beside_a_run(self):
        process, address = self.started("run", str(CONFIGS / "demo.yaml"), "-o", "out", "-q", *SMALL, "--set", "time.end_s=60", "--watch", stream="stderr")
        seen, started = [], time.monotonic()
        while time.monotonic() - started < PATIENCE:
            sections = json.loads(fetch(address.replace("/?", "/data.json?")))["sections"]
            if sections and sections[0]["progress"]:
                seen.append(sections[0]["progress"]["time_s"])
                self.assertEqual(sections[0]["state"], "running")
                self.assertEqual(sections[0]["progress"]["end_s"], 60)
            if len(seen) > 1 and seen[-1] > seen[0]:
                break
            time.sleep(0.5)
        self.assertGreater(seen[-1], seen[0])
        process.kill()
        process.wait()
        for _ in range(50):
            try:
                fetch(address)
            except (urllib.error.URLError, ConnectionError):
                return
            time.sleep(0.1)
        self.fail("the page outlived its run")

    def test_bad_input(self):
        for words, reason in ((("watch", "gone"), "no such folder"), (("watch", ".", "--port", "0"), "--port 0")):
            said = call(self.folder, *words, code=2).stderr
            self.assertEqual(said.count("\n"), 1)
            self.assertIn(reason, said)


if __name__ == "__main__":
    unittest.main()
