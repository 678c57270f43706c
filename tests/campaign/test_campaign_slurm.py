"""Campaigns on a real Slurm of one node: tasks and heads are killed, the controller is restarted, and nothing is lost."""
import os
import pathlib
import shutil
import signal
import unittest

import slurm_machine
from campaigns import PATIENCE, CampaignTest

THREE = {name: [f"seed={seed}"] for seed, name in enumerate(("a", "b", "c"), 1)}
END = 2.0  # s of simulated time: about a second of computing each

LACKING = slurm_machine.lacking()


@unittest.skipIf(LACKING, LACKING)
class Slurm(CampaignTest):
    expected = None

    @classmethod
    def setUpClass(cls):
        cls.machine = slurm_machine.SlurmMachine()
        cls.addClassCleanup(cls.machine.stop)

    def setUp(self):
        super().setUp()
        self.addCleanup(self.machine.ask, "scancel", "--user=root")
        self.tasks(THREE, END)
        if Slurm.expected is None:
            self.succeed("campaign", "tasks.yaml", "-o", "whole", "-q")
            Slurm.expected = self.hashes("whole")

    def on_slurm(self, *words, start=False, **options):
        call = self.start if start else self.millscope
        return call("campaign", "tasks.yaml", "-o", "out", "--runner", "slurm", "--poll", "0.3", *words, env=self.machine.environment, **options)

    def finish(self):
        result = self.on_slurm()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.hashes("out"), Slurm.expected)
        return result

    def batches(self):
        return sorted((self.folder / "out/cache/slurm").glob("*"))

    def entries_of(self, batch):
        return [pathlib.Path(line) for line in (batch / "entries.txt").read_text(encoding="utf-8").splitlines()]

    def running(self):
        """[(task, entry)] of those tasks that run and have written a checkpoint."""
        found = []
        for task, (state, name) in self.machine.tasks().items():
            batch = self.folder / "out/cache/slurm" / name.removeprefix("millscope-")
            if state == "RUNNING" and batch.exists():
                entry = self.entries_of(batch)[int(task.rsplit("_", 1)[1])]
                if (entry / "run/checkpoint.h5").exists() and not (entry / "run/summary.json").exists():
                    found.append((task, entry))
        return found

    def process_of(self, entry):
        for cmdline in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
            try:
                words = cmdline.read_bytes().split(b"\0")
            except OSError:
                continue
            if b"campaign-task" in words and str(entry).encode() in words:
                return int(cmdline.parent.name)
        return None

    def test_a_campaign(self):
        result = self.finish()
        self.assertIn("3 computed now, 0 failed", result.stdout)
        self.assertEqual(len(self.batches()), 1)
        self.assertRegex((self.batches()[0] / "job").read_text(encoding="utf-8"), r"^\d+\n$")
        again = self.on_slurm()
        self.assertIn("0 computed now", again.stdout)
        self.assertEqual(len(self.batches()), 1)

    @unittest.skipUnless(shutil.which("liggghts") and shutil.which("mpirun") and len(os.sched_getaffinity(0)) > 1, "no liggghts, mpirun or second core here")
    def test_ranks_of_another_engine_are_tasks_of_slurm(self):
        engine = ["run.engine=liggghts", "run.ranks=2"]
        self.tasks({"theirs": engine, "ours": []}, 0.06)
        result = self.on_slurm()
        self.assertEqual(result.returncode, 0, result.stderr)
        table = self.table()
        self.assertEqual({row["state"] for row in table.values()}, {"done"}, table)
        self.assertEqual(self.run_summary(table["theirs"]["folder"])["engine"]["ranks"], 2)
        log = (pathlib.Path(table["theirs"]["folder"]) / "engine/log.liggghts").read_text(encoding="utf-8")
        self.assertIn("2 by 1 by 1 MPI processor grid", log)
        self.assertEqual(len(self.batches()), 2)  # those of an array have as many cores each

    def test_kill_a_task_and_the_head(self):
        head = self.on_slurm("-q", start=True)
        self.wait_until(self.running, "a task had a checkpoint")
        task, entry = self.running()[0]
        process = self.process_of(entry)
        self.assertIsNotNone(process)
        os.kill(process, signal.SIGKILL)
        head.send_signal(signal.SIGKILL)
        head.wait(60)
        self.finish()
        self.assertGreaterEqual(len(self.batches()), 2, f"task {task} was not handed over again")
        self.assertIn("resume", self.run_summary(entry / "run")["provenance"]["command_line"])

    def test_a_lost_task_is_handed_over_again_while_the_head_lives(self):
        head = self.on_slurm("-q", start=True)
        self.wait_until(self.running, "a task had a checkpoint")
        task, _ = self.running()[0]
        self.machine.ask("scancel", task)
        _, err = head.communicate(timeout=PATIENCE)
        self.assertEqual(head.returncode, 0, err)
        self.assertEqual(self.hashes("out"), Slurm.expected)
        self.assertGreaterEqual(len(self.batches()), 2)

    def test_tasks_go_on_without_a_head(self):
        head = self.on_slurm("-q", start=True)
        self.wait_until(self.running, "a task had a checkpoint")
        head.send_signal(signal.SIGKILL)
        head.wait(60)
        self.wait_until(lambda: not self.machine.tasks(), "the tasks had ended")
        self.assertEqual({task["state"] for _, task in self.tasks_of("out/cache").values()}, {"done"})
        self.assertIn("0 computed now", self.finish().stdout)
        self.assertEqual(len(self.batches()), 1)

    def test_a_head_that_comes_back_finds_its_tasks(self):
        head = self.on_slurm(start=True)
        self.wait_until(self.running, "a task had a checkpoint")
        head.send_signal(signal.SIGINT)
        _, err = head.communicate(timeout=PATIENCE)
        self.assertEqual(head.returncode, 3, err)
        self.assertRegex(err, r"the tasks stay in Slurm and go on \(scancel --name=millscope-\S+ ends them\)")
        self.finish()
        self.assertEqual(len(self.batches()), 1)

    def test_the_controller_is_restarted(self):
        head = self.on_slurm("-q", start=True)
        self.wait_until(self.running, "a task had a checkpoint")
        self.machine.stop_controller()
        self.assertEqual(self.machine.ask("squeue", "-h"), "")
        self.machine.start_controller()
        _, err = head.communicate(timeout=PATIENCE)
        self.assertEqual(head.returncode, 0, err)
        self.assertEqual(self.hashes("out"), Slurm.expected)

    def test_a_task_that_is_always_lost_is_given_up(self):
        self.tasks({"long": ["time.end_s=1000", "output.checkpoint=off"], "short": ["time.end_s=0.06"]}, 1)
        head = self.on_slurm("-q", start=True)
        killed = []

        def kill_the_long_one():
            entry, _ = self.tasks_of("out/cache").get("long", (None, None))
            process = self.process_of(entry) if entry else None
            if process and process not in killed and (entry / "run/series.csv").exists():
                os.kill(process, signal.SIGKILL)
                killed.append(process)
            return head.poll() is not None

        self.wait_until(kill_the_long_one, "the campaign ended")
        self.assertEqual(head.returncode, 0, head.stderr.read())
        self.assertEqual(len(killed), 3)
        self.assertEqual(self.table()["short"]["state"], "done")
        self.assertIn("lost 3 times in Slurm", self.table()["long"]["message"])

    def test_options_for_sbatch(self):
        self.assert_one_line(self.on_slurm("-q", "--slurm=--partition=nowhere"), "sbatch refuses the campaign", "partition")
        self.assertEqual([folder for folder, _ in self.tasks_of("out/cache").values() if (folder / "job.json").exists()], [])
        result = self.on_slurm("-q", "--slots", "1", "--slurm", "--partition=main --time=5")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.hashes("out"), Slurm.expected)


if __name__ == "__main__":
    unittest.main()
