"""A campaign whose head or simulations are killed, interrupted or doubled: nothing is lost, and the end is the same."""
import os
import shutil
import signal
import time
import unittest

from campaigns import PATIENCE, CampaignTest, tree_of

FOUR = {name: [f"seed={seed}"] for seed, name in enumerate(("a", "b", "c", "d"), 1)}
PROBE = 0.4  # s of simulated time, to see how fast this machine is
SECONDS = 0.8  # of computing of each simulation: several checkpoints, on a fast machine, too


class Kills(CampaignTest):
    expected = None
    end = None  # s of simulated time

    def setUp(self):
        super().setUp()
        if Kills.end is None:
            start = time.monotonic()
            self.succeed("run", "case.yaml", "-o", "probe", "-q", "--set", f"time.end_s={PROBE}")
            Kills.end = round(PROBE * max(1, SECONDS / (time.monotonic() - start)), 3)
        self.tasks(FOUR, Kills.end)
        if Kills.expected is None:
            self.succeed("campaign", "tasks.yaml", "-o", "whole", "-q")
            Kills.expected = self.hashes("whole")
            self.assertEqual(len(set(Kills.expected.values())), 4)

    def start_campaign(self, *words):
        return self.start("campaign", "tasks.yaml", "-o", "out", *words)

    def one_done_one_under_way(self):
        """True when the first is done and another has a checkpoint."""
        tasks = self.tasks_of("out/cache").values()
        done = [folder for folder, _ in tasks if (folder / "run/summary.json").exists()]
        under_way = [folder for folder, _ in tasks if folder not in done and (folder / "run/checkpoint.h5").exists()]
        return bool(done) and bool(under_way)

    def unfinished_runs(self):
        folders = [folder for folder, _ in self.tasks_of("out/cache").values()]
        return [folder / "run" for folder in folders if not (folder / "run/summary.json").exists()]

    def finish(self):
        """Runs the same command to its end; the results must be those of a campaign that nothing disturbed."""
        result = self.succeed("campaign", "tasks.yaml", "-o", "out")
        self.assertEqual(self.hashes("out"), Kills.expected)
        return result

    def kill_the_head(self):
        """The runs that were finished when the head was killed, as they were, and those that its orphans left unfinished."""
        head = self.start_campaign("-q", "--slots", 1)
        self.wait_until(self.one_done_one_under_way, "one was done and one had a checkpoint")
        runs = [folder / "run" for folder, _ in self.tasks_of("out/cache").values()]
        head.send_signal(signal.SIGKILL)
        head.wait(60)
        finished = {run: tree_of(run) for run in runs if (run / "summary.json").exists()}
        self.wait_until(lambda: not any(self.is_writing(run) for run in runs), "the orphan had stopped")
        return finished, [run for run in runs if (run / "checkpoint.h5").exists() and not (run / "summary.json").exists()]

    def test_kill_the_head(self):
        for _ in range(5):  # an orphan may come to its end before it hears of the head's
            finished, under_way = self.kill_the_head()
            if under_way:
                break
            shutil.rmtree(self.folder / "out")
        self.assertTrue(under_way)
        self.finish()
        for run, before in finished.items():
            self.assertEqual(tree_of(run), before)
        for run in under_way:
            self.assertIn("resume", self.run_summary(run)["provenance"]["command_line"])

    def test_kill_head_and_simulations_at_once(self):
        """As a power cut: no process gets to write anything more. What is lost is at most a checkpoint's interval."""
        head = self.start_campaign("-q", "--slots", 2)
        self.wait_until(self.one_done_one_under_way, "one was done and one had a checkpoint")
        head.send_signal(signal.SIGSTOP)
        for child in self.children_of(head.pid):
            os.kill(child, signal.SIGKILL)
        head.kill()
        head.wait(60)
        self.finish()

    def test_restart_while_the_orphans_still_write(self):
        head = self.start_campaign("-q")
        self.wait_until(lambda: len(self.children_of(head.pid)) > 0, "a simulation ran")
        head.send_signal(signal.SIGKILL)
        head.wait(60)
        self.finish()

    def test_kill_again_and_again(self):
        for k in range(6):
            head = self.start_campaign("-q")
            try:
                head.wait(0.05 + 0.12 * k)
            except Exception:  # it has not ended yet
                head.kill()
                head.wait(60)
        self.finish()

    def test_signals(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            head = self.start_campaign("--slots", 1)
            self.wait_until(lambda: self.children_of(head.pid) and any((run / "checkpoint.h5").exists() for run in self.unfinished_runs()),
                            "a simulation ran and had a checkpoint")
            head.send_signal(number)
            _, err = head.communicate(timeout=PATIENCE)
            self.assertEqual(head.returncode, 3, err)
            known = "" if number == signal.SIGINT else r"( \(\d from the cache\))?"  # the first may have finished some
            self.assertRegex(err, r"millscope: stopped: \d of 4 done" + known + r"; .*checkpoints; the same command goes on")
            self.assertIn("open", {row["state"] for row in self.table().values()})
            self.assertEqual([folder for folder, _ in self.tasks_of("out/cache").values() if (folder / "lock").exists()], [])
        self.finish()

    def test_a_signal_at_once(self):
        """Before a simulation listens to signals: it is not held against it."""
        for _ in range(3):
            head = self.start_campaign("--slots", 1)
            self.wait_until(lambda: head.poll() is not None or self.children_of(head.pid), "a simulation was started")
            head.send_signal(signal.SIGTERM)
            _, err = head.communicate(timeout=PATIENCE)
            self.assertEqual(head.returncode, 3, err)
        self.finish()

    def test_two_heads(self):
        heads = [self.start("campaign", "tasks.yaml", "-o", out, "--cache", "cache", "--slots", 1) for out in ("out", "other")]
        computed = 0
        for head in heads:
            out, err = head.communicate(timeout=PATIENCE)
            self.assertEqual(head.returncode, 0, err)
            computed += int(out.split(" computed now")[0].rsplit(" ", 1)[1])
        self.assertEqual(computed, 4)
        self.assertEqual({task["attempts"] for _, task in self.tasks_of("cache").values()}, {1})
        self.assertEqual(self.hashes("out"), Kills.expected)
        self.assertEqual(self.hashes("other"), Kills.expected)

    def test_a_head_takes_over_from_a_killed_one(self):
        first = self.start("campaign", "tasks.yaml", "-o", "out", "-q", "--slots", 1)
        self.wait_until(lambda: len(self.children_of(first.pid)) > 0, "a simulation ran")
        second = self.start("campaign", "tasks.yaml", "-o", "other", "--cache", "out/cache", "-q", "--slots", 1)
        self.wait_until(lambda: len(self.children_of(second.pid)) > 0, "both were at work")
        first.kill()
        first.wait(60)
        self.assertEqual(second.wait(120), 0)
        self.assertEqual(self.hashes("other"), Kills.expected)

    def test_a_simulation_that_is_shot(self):
        head = self.start_campaign("--slots", 1)
        self.wait_until(lambda: len(self.children_of(head.pid)) > 0, "a simulation ran")
        os.kill(self.children_of(head.pid)[0], signal.SIGSEGV)
        _, err = head.communicate(timeout=PATIENCE)
        self.assertEqual(head.returncode, 0, err)
        states = [row["state"] for row in self.table().values()]
        self.assertEqual(sorted(states), ["done", "done", "done", "failed"])
        failed = next(row for row in self.table().values() if row["state"] == "failed")
        self.assertIn("crashed: Segmentation fault", failed["message"])
        self.assertIn("1 computed now, 0 failed", self.succeed("campaign", "tasks.yaml", "-o", "out", "--retry-failed").stdout)
        self.assertEqual(self.hashes("out"), Kills.expected)

    def test_a_simulation_that_is_told_to_stop_goes_on(self):
        head = self.start_campaign("-q", "--slots", 1)
        self.wait_until(self.one_done_one_under_way, "a simulation had a checkpoint")
        for child in self.children_of(head.pid):
            os.kill(child, signal.SIGTERM)
        self.assertEqual(head.wait(120), 0)
        self.assertEqual(self.hashes("out"), Kills.expected)

    def test_a_damaged_checkpoint(self):
        head = self.start_campaign("-q", "--slots", 1)
        self.wait_until(self.one_done_one_under_way, "one was done and one had a checkpoint")
        head.kill()
        head.wait(60)
        runs = [folder / "run" for folder, _ in self.tasks_of("out/cache").values()]
        self.wait_until(lambda: not any(self.is_writing(run) for run in runs), "the orphan had stopped")
        for run in runs:
            for file in run.glob("checkpoint*.h5"):
                if not (run / "summary.json").exists():
                    file.write_bytes(file.read_bytes()[:100])
        self.finish()

    def test_a_case_that_is_edited_meanwhile(self):
        """What was begun is finished as it was begun, under its own key."""
        head = self.start_campaign("-q", "--slots", 1)
        self.wait_until(lambda: len(self.children_of(head.pid)) > 0, "a simulation ran")
        case = self.folder / "case.yaml"
        text = case.read_text(encoding="utf-8")
        case.write_text(text.replace("restitution: 0.6", "restitution: 0.5"), encoding="utf-8")
        self.assertEqual(head.wait(120), 0)
        self.assertEqual(self.hashes("out"), Kills.expected)
        case.write_text(text, encoding="utf-8")
        self.assertIn("0 computed now", self.finish().stdout)


if __name__ == "__main__":
    unittest.main()
