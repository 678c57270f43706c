"""The command `campaign` as a user meets it: the table, the cache, plugins, meshes, bad input."""
import os
import pathlib
import shutil
import unittest

import campaigns
from campaigns import COMMAND, CampaignTest, tree_of

SPEEDS = {"slow": ["mill.speed=50 %critical"], "fast": ["mill.speed=75 %critical"]}


class Campaign(CampaignTest):
    def test_the_table_and_the_cache(self):
        self.tasks(SPEEDS)
        result = self.succeed("campaign", "tasks.yaml", "-o", "out")
        self.assertIn("2 simulations, 2 computed now, 0 failed", result.stdout)
        table = self.table()
        self.assertEqual(list(table), ["slow", "fast"])
        for row in table.values():
            self.assertEqual((row["state"], row["cached"]), ("done", "no"))
            self.assertGreater(float(row["wall_s"]), 0)
            self.assertEqual(pathlib.Path(row["folder"]), self.folder / "out/cache" / row["key"] / "run")
        before = tree_of(self.folder / "out/cache")
        again = self.succeed("campaign", "tasks.yaml", "-o", "out")
        self.assertIn("2 simulations, 0 computed now, 0 failed", again.stdout)
        self.assertEqual(tree_of(self.folder / "out/cache"), before)

    def test_a_widened_campaign_computes_only_what_is_new(self):
        self.tasks(SPEEDS)
        self.succeed("campaign", "tasks.yaml", "-o", "out", "-q")
        self.tasks({**SPEEDS, "faster": ["mill.speed=90 %critical"]})
        result = self.succeed("campaign", "tasks.yaml", "-o", "other", "--cache", "out/cache")
        self.assertIn("3 simulations, 1 computed now, 0 failed", result.stdout)

    def test_the_result_is_that_of_the_run_itself(self):
        self.tasks(SPEEDS)
        self.succeed("campaign", "tasks.yaml", "-o", "out", "-q")
        alone = self.run_case("alone", "--set", "time.end_s=0.06", "--set", "mill.speed=50 %critical", "--threads", 2)
        self.assertEqual(self.hashes()["slow"], alone["state_hash"])
        self.assertEqual(self.run_summary(self.table()["slow"]["folder"])["threads"], 1)

    def test_what_fails_is_noted_and_the_rest_is_done(self):
        self.tasks({"wild": ["time.step_s=0.002", "run.allow_unstable=true"], "unstable": ["time.step_fraction=0.9"], "typo": ["mill.sped=3"], **SPEEDS})
        result = self.succeed("campaign", "tasks.yaml", "-o", "out")
        self.assertIn("3 failed", result.stdout)
        table = self.table()
        self.assertEqual([row["state"] for row in table.values()], ["failed", "failed", "failed", "done", "done"])
        self.assertIn("moved more than half its radius", table["wild"]["message"])
        self.assertIn("Rayleigh time", table["unstable"]["message"])
        self.assertIn("did you mean 'speed'?", table["typo"]["message"])
        self.assertIn("0 computed now, 3 failed", self.succeed("campaign", "tasks.yaml", "-o", "out").stdout)
        self.assertIn("2 computed now, 3 failed", self.succeed("campaign", "tasks.yaml", "-o", "out", "--retry-failed").stdout)

    def at_once(self, slots):
        """How many engines ran at once, at most: each is a few lines of shell, of two ranks."""
        log, out = self.folder / f"log{slots}", f"out{slots}"
        (self.folder / "bin").mkdir(exist_ok=True)
        for name in ("liggghts", "mpirun"):
            text = ("#!/bin/sh\ncase $1 in -h|--version) echo 'LIGGGHTS (Version LIGGGHTS-PUBLIC 3.8.0)'; exit;; esac\n"
                    f"echo begin >> {log}; sleep 0.5; echo end >> {log}; exit 1\n")
            (self.folder / "bin" / name).write_text(text, encoding="utf-8")
            (self.folder / "bin" / name).chmod(0o755)
        self.tasks({name: [f"seed={seed}", "run.engine=liggghts", "run.ranks=2"] for seed, name in enumerate("abcd", 1)})
        path = f"{self.folder / 'bin'}:{os.environ['PATH']}"
        self.assert_one_line(self.millscope("campaign", "tasks.yaml", "-o", out, "-q", "--slots", slots, env=campaigns.environment(PATH=path)), "all simulations failed")
        now = most = 0
        for line in log.read_text(encoding="utf-8").split():
            now += 1 if line == "begin" else -1
            most = max(most, now)
        return most

    def test_an_engine_of_two_ranks_takes_two_slots(self):
        self.assertEqual(self.at_once(4), 2)
        self.assertEqual(self.at_once(3), 1)
        self.assertEqual(self.at_once(1), 1)  # one is always let go

    def test_all_failed_is_an_error(self):
        self.tasks({"unstable": ["time.step_fraction=0.9"]})
        result = self.millscope("campaign", "tasks.yaml", "-o", "out", "-q")
        self.assert_one_line(result, "all simulations failed", "unstable", "Rayleigh")
        self.assertEqual(self.table()["unstable"]["state"], "failed")

    def test_a_mesh_is_kept_with_the_cache(self):
        self.succeed("geometry", "export", "case.yaml", "-o", "liner.stl", "--binary")
        text = (self.folder / "case.yaml").read_text(encoding="utf-8")
        begin, end = text.index("    kind: mill\n"), text.index("    material: hdpe\n")
        self.write("case.yaml", text[:begin] + "    kind: mesh\n    file: liner.stl\n    unit: m\n" + text[end:])
        self.tasks({"mesh": ["mill.speed=50 %critical"]})
        self.succeed("campaign", "tasks.yaml", "-o", "out", "-q")
        folder, _ = self.tasks_of("out/cache")["mesh"]
        self.assertNotIn(str(self.folder), (folder / "case.yaml").read_text(encoding="utf-8"))
        copies = list((self.folder / "out/cache/files").iterdir())
        self.assertEqual([c.read_bytes() for c in copies], [(self.folder / "liner.stl").read_bytes()])
        key = self.table()["mesh"]["key"]
        data = (self.folder / "liner.stl").read_bytes()
        (self.folder / "liner.stl").write_bytes(b"another header".ljust(80) + data[80:])
        self.succeed("campaign", "tasks.yaml", "-o", "out", "-q")
        self.assertNotEqual(self.table()["mesh"]["key"], key)

    def test_the_plugins_of_a_case_belong_to_its_key(self):
        command = pathlib.Path(COMMAND)
        plugins = self.folder / "install/lib/millscope/plugins"
        shutil.copytree(command.parent.parent / "lib/millscope/plugins", plugins, symlinks=False)
        for path in [self.folder / "install", *(self.folder / "install").rglob("*")]:
            path.chmod(0o755)
        (self.folder / "install/bin").mkdir()
        shutil.copy(command, self.folder / "install/bin/millscope")
        self.tasks({"one": []})

        def key():
            self.succeed("campaign", "tasks.yaml", "-o", "out", "-q", executable=str(self.folder / "install/bin/millscope"))
            return self.table()["one"]["key"]

        def touch(name, old, new):
            data = (plugins / name).read_bytes()
            self.assertIn(old, data)
            (plugins / name).write_bytes(data.replace(old, new))

        first = key()
        self.assertEqual(key(), first)
        touch("libmesh.so", b"Factor on top", b"Factor on tOp")  # not used by the case
        self.assertEqual(key(), first)
        with open(plugins / "libgravity.so", "ab") as file:  # behind the library's end
            file.write(b"x")
        self.assertEqual(key(), first)
        touch("libgravity.so", b"acceleration", b"accElEration")
        second = key()
        self.assertNotEqual(second, first)
        self.assertEqual(second[:32], first[:32])
        touch("v2/libhertz_mindlin.so", b"Mindlin", b"MindlIn")  # a build that this machine may not even take
        self.assertNotEqual(key(), second)

    def test_the_instruction_set_leaves_the_key(self):
        self.tasks({"one": []})
        keys = set()
        for level in ("v2", "v3"):
            self.succeed("campaign", "tasks.yaml", "-o", "out", "-q", env=campaigns.environment(MILLSCOPE_INSTRUCTION_SET=level))
            keys.add(self.table()["one"]["key"])
        self.assertEqual(len(keys), 1)

    def test_progress(self):
        self.tasks({"a": [], "b": ["seed=2"]}, end=0.5)
        result = self.succeed("campaign", "tasks.yaml", "-o", "out")
        self.assertRegex(result.stderr, r"campaign: 0 of 2 done, \d running, ETA")
        self.assertEqual(self.succeed("campaign", "tasks.yaml", "-o", "other", "-q").stderr, "")

    def test_bad_input(self):
        self.tasks(SPEEDS)
        self.assert_one_line(self.millscope("campaign", "nowhere.yaml", "-o", "out"), "nowhere.yaml")
        self.assert_one_line(self.millscope("campaign", "tasks.yaml"), "output.*is missing")
        self.assert_one_line(self.millscope("campaign", "tasks.yaml", "-o", "out", "--slots", "0"), "--slots 0")
        self.assert_one_line(self.millscope("campaign", "tasks.yaml", "-o", "out", "--memory", "-1"), "--memory -1")
        self.assert_one_line(self.millscope("campaign", "tasks.yaml", "-o", "out", "--runner", "cloud"), "local or slurm")
        empty = self.folder / "nothing"
        empty.mkdir()
        self.assert_one_line(self.millscope("campaign", "tasks.yaml", "-o", "out", "--runner", "slurm", env=campaigns.environment(PATH=str(empty))),
                             "sbatch.*cannot be started", "runner local")
        self.assert_one_line(self.millscope("campaign-task", "nothing"), "no simulation of a campaign")

    @unittest.skipIf(os.geteuid() == 0, "root may write anywhere")
    def test_a_cache_that_cannot_be_written(self):
        self.tasks(SPEEDS)
        (self.folder / "closed").mkdir(mode=0o500)
        self.assert_one_line(self.millscope("campaign", "tasks.yaml", "-o", "out", "--cache", "closed/cache"), "closed", code=4)


if __name__ == "__main__":
    unittest.main()
