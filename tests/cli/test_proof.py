"""tools/proof.py on a repository of its own, with a program that plays millscope."""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tools"))
import proof  # noqa: E402

# Answers hold the seed, so that another seed would show; a diagnosis is what was asked for, set_002 fails where build/fail.txt is.
PLAYED = r'''#!/usr/bin/env python3
import hashlib, json, os, sys, pathlib
words = sys.argv[1:]
DIAGNOSIS = {"verdict": "no_mismatch", "unit": "m/s", "study": "/a/b/set/study.yaml",
             "failures": ["base_2: plugin '/a/b/v4/libmill.so' is not loaded (searched: /a/b/plugins; add one)", "base_3: /a/b-c/case.yaml:61: \"x\""]}
if words == ["--version"]:
    print("millscope 0.1.0 (commit %s)" % ((pathlib.Path(__file__).parent / "commit").read_text().strip()))
if words[:2] == ["challenge", "make"]:
    out = pathlib.Path(words[words.index("-o") + 1])
    seed = [line for line in open(words[2]) if line.startswith("seed:")][0].split()[1]
    for name in ("set_001", "set_002"):
        (out / name).mkdir(parents=True)
        (out / name / "r.a").write_text("%s %s" % (name, seed))
        home = pathlib.Path(words[2]).parent.resolve()
        (out / name / "study.yaml").write_text('include: ["%s/s.yaml"]\n' % os.path.relpath(home, out / name))
        (out / "answers").mkdir(exist_ok=True)
        (out / "answers" / (name + ".json")).write_text(json.dumps({"seed": seed, "set": name}))
    sets = [{"set": n, "answer_hash": hashlib.sha256((out / "answers" / (n + ".json")).read_bytes()).hexdigest()} for n in ("set_001", "set_002")]
    (out / "manifest.json").write_text(json.dumps({"sets": sets}))
elif words[:2] == ["challenge", "run"]:
    for name in ("set_001", "set_002"):
        found = pathlib.Path(words[2]) / name / "diagnosis"
        found.mkdir(exist_ok=True)
        if name == "set_002" and pathlib.Path("build/fail.txt").exists():
            (found / "failed.txt").write_text("/a/b/case.yaml:61: too few beads\n")
        elif not (found / "diagnosis.json").exists():
            (found / "diagnosis.json").write_text(json.dumps(DIAGNOSIS))
elif words[:2] == ["challenge", "conceal"]:
    (pathlib.Path(words[3]) / "concealment.json").write_text(words[2])
elif words[:2] == ["challenge", "score"]:
    folders = words[2:words.index("-o")]
    for f in folders: assert (pathlib.Path(f) / "answers" / "set_001.json").exists()
    pathlib.Path(words[words.index("-o") + 1]).write_text("# %s\n" % " ".join(folders))
'''


class Proof(unittest.TestCase):
    def setUp(self):
        self.root, self.elsewhere = Path(tempfile.mkdtemp()).resolve(), Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        self.addCleanup(shutil.rmtree, self.elsewhere)
        for folder in ("tools", "configs/proof", "kernel", "build/release/bin", "docs"):
            (self.root / folder).mkdir(parents=True)
        shutil.copy(SOURCE / "tools" / "proof.py", self.root / "tools")
        (self.root / "configs/proof/proof.yaml").write_text("# what is made\nparts:\n  part: {challenge: part.yaml, batches: 2}\n")
        (self.root / "configs/proof/part.yaml").write_text("study: s.yaml\nseed: 1\n")
        (self.root / "kernel/a.cpp").write_text("int a;\n")
        (self.root / ".gitignore").write_text("/build/\n")
        program = self.root / "build/release/bin/millscope"
        program.write_text(PLAYED)
        program.chmod(0o755)
        self.program = program
        self.git("init", "-q")
        self.git("config", "user.email", "a@b.c")
        self.git("config", "user.name", "a")
        self.commit()

    def git(self, *words):
        subprocess.run(["git", "-C", str(self.root)] + list(words), check=True, capture_output=True)

    def commit(self):
        self.git("add", "-A")
        self.git("commit", "-q", "--allow-empty", "-m", "step")
        self.build()

    def build(self):
        head = subprocess.run(["git", "-C", str(self.root), "rev-parse", "HEAD"], check=True, capture_output=True, text=True)
        (self.program.parent / "commit").write_text(head.stdout)

    def proof(self, *words):
        done = subprocess.run([sys.executable, str(self.root / "tools/proof.py")] + list(words), capture_output=True, text=True)
        return done.returncode, done.stderr

    def public(self, path):
        return self.root / "docs/proof/part_1" / path

    def test_a_batch_is_for_the_commit_that_decides_whatever_pages_and_other_challenges_changed_since(self):
        self.assertEqual(self.proof("part_1", "--until", "publish"), (0, ""))
        first = json.loads(self.public("frozen.json").read_text())["commit"]
        for path, same in (("docs/page.md", True), ("configs/other.yaml", True), ("configs/proof/part.yaml", False), ("kernel/a.cpp", False)):
            shutil.rmtree(self.public("").parent)
            shutil.rmtree(self.root / "build/release/proof")
            file = self.root / path
            file.write_text((file.read_text() if file.exists() else "") + "\n")
            self.commit()
            self.assertEqual(self.proof("part_1", "--until", "publish"), (0, ""), path)
            (self.assertEqual if same else self.assertNotEqual)(json.loads(self.public("frozen.json").read_text())["commit"], first, path)
            first = json.loads(self.public("frozen.json").read_text())["commit"]

    def test_what_judges_may_change_between_making_and_publishing_and_nothing_else(self):
        mark = self.root / "build/release/proof/part_1/commit.txt"
        changes = (("studies/diagnose/naming/b.cpp", True), ("studies/diagnose/question/b.cpp", False), ("studies/calibrate/b.cpp", False),
                   ("configs/proof/part.yaml", False), ("configs/other.yaml", True))
        for path, kept in changes:
            self.assertEqual(self.proof("part_1", "--until", "make"), (0, ""))
            self.assertFalse(self.public("").exists())
            self.assertFalse((mark.parent / "answers").exists() or (mark.parent / "seed.txt").exists())
            first = mark.read_text()
            file = self.root / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text((file.read_text() if file.exists() else "") + "\n")
            self.commit()
            self.assertEqual(self.proof("part_1", "--until", "publish"), (0, ""))
            (self.assertEqual if kept else self.assertNotEqual)(mark.read_text(), first, path)
            self.assertEqual(json.loads(self.public("frozen.json").read_text())["made_by"], mark.read_text())
            shutil.rmtree(self.public("").parent)
            shutil.rmtree(self.root / "build/release/proof")

    def test_what_was_diagnosed_or_changed_before_it_was_published_is_refused(self):
        self.proof("part_1", "--until", "make")
        recorded = self.root / "build/release/proof/part_1/set_001"
        (recorded / "diagnosis").mkdir()
        self.assertIn("diagnosed before it was published", self.proof("part_1")[1])
        (recorded / "diagnosis").rmdir()
        (recorded / "r.a").write_text("other")
        self.assertIn("not those that were made", self.proof("part_1")[1])
        self.assertFalse(self.public("").exists())

    def test_a_batch_is_published_diagnosed_opened_and_scored_in_this_order(self):
        self.assertEqual(self.proof("part_1", "--until", "publish"), (0, ""))
        frozen = json.loads(self.public("frozen.json").read_text())
        self.assertEqual(sorted(frozen["recordings_sha256"]), ["set_001/r.a", "set_001/study.yaml", "set_002/r.a", "set_002/study.yaml"])
        self.assertFalse(self.public("answers").exists())
        self.assertIn("commit docs/proof/part_1 first", self.proof("part_1")[1])
        self.assertFalse(self.public("set_001").exists())
        self.commit()
        self.assertIn("commit the diagnoses", self.proof("part_1")[1])
        said = {"verdict": "no_mismatch", "unit": "m/s", "study": "set_001/study.yaml",
                "failures": ["base_2: plugin 'libmill.so' is not loaded (searched: plugins; add one)", "base_3: case.yaml:61: \"x\""]}
        self.assertEqual(json.loads(self.public("set_001/diagnosis/diagnosis.json").read_text()), said)
        self.assertFalse(self.public("answers").exists())
        self.commit()
        self.assertEqual(self.proof("part_1")[0], 0)
        answer = json.loads(self.public("answers/set_001.json").read_text())
        self.assertFalse((self.root / "build/release/proof/part_1/answers").exists())
        self.assertFalse((self.root / "build/release/proof/part_1/seed.txt").exists())
        self.assertNotEqual(answer["seed"], "1")
        self.assertTrue(self.public("concealment.json").read_text().endswith("configs/proof/part.yaml"))
        self.assertEqual((self.root / "docs/proof.md").read_text(), "# docs/proof/part_1\n")

    def test_another_clone_makes_the_same_recordings_and_goes_on(self):
        self.proof("part_1", "--until", "publish")
        self.commit()
        shutil.rmtree(self.root / "build/release/proof")
        elsewhere = self.elsewhere / "a"
        shutil.move(self.root / "build/release", elsewhere)
        self.assertEqual(self.proof("part_1", "--until", "diagnose", "--build", str(elsewhere))[:2], (0, ""))
        self.assertTrue(self.public("set_002/diagnosis/diagnosis.json").exists())
        self.assertEqual(self.public("manifest.json").read_bytes(), (elsewhere / "proof/part_1/manifest.json").read_bytes())

    def test_a_study_that_was_changed_is_refused(self):
        self.proof("part_1", "--until", "publish")
        self.commit()
        (self.root / "build/release/proof/part_1/set_001/study.yaml").write_text('include: ["../../../../../configs/other/s.yaml"]\n')
        self.assertIn("not those that were published", self.proof("part_1")[1])
        (self.root / "build/release/proof/part_1/set_001/study.yaml").write_text('include: ["/elsewhere/s.yaml"]\n')
        self.assertIn("no file of this clone", self.proof("part_1")[1])

    def test_recordings_that_were_changed_are_refused(self):
        self.proof("part_1", "--until", "publish")
        self.commit()
        (self.root / "build/release/proof/part_1/set_001/r.a").write_text("other")
        self.assertIn("not those that were published", self.proof("part_1")[1])

    def test_a_program_that_has_changed_diagnoses_nothing(self):
        self.proof("part_1", "--until", "publish")
        self.commit()
        (self.root / "kernel/a.cpp").write_text("int b;\n")
        self.assertIn("kernel/a.cpp differs since", self.proof("part_1")[1])
        self.commit()
        self.assertIn("kernel/a.cpp differs since", self.proof("part_1")[1])
        self.assertFalse(self.public("set_001").exists())

    def test_a_case_that_only_others_read_may_change(self):
        (self.root / "configs/proof/s.yaml").write_text("base: ../mill.yaml\n")
        (self.root / "configs/mill.yaml").write_text("beads: 1\n")
        self.commit()
        self.proof("part_1", "--until", "publish")
        self.commit()
        (self.root / "configs/other.yaml").write_text("beads: 2\n")
        self.assertEqual(self.proof("part_1", "--until", "diagnose")[:2], (0, ""))
        shutil.rmtree(self.root / "docs/proof/part_1/set_002")
        self.commit()
        (self.root / "configs/other.yaml").write_text("beads: 3\n")
        self.assertEqual(self.proof("part_1", "--until", "diagnose")[:2], (0, ""))
        shutil.rmtree(self.root / "docs/proof/part_1/set_001")
        (self.root / "configs/mill.yaml").write_text("beads: 2\n")
        self.assertIn("configs/mill.yaml differs since", self.proof("part_1")[1])

    def test_an_older_build_diagnoses_nothing(self):
        old = (self.program.parent / "commit").read_text()
        (self.root / "kernel/a.cpp").write_text("int b;\n")
        self.commit()
        self.proof("part_1", "--until", "publish")
        self.commit()
        (self.program.parent / "commit").write_text(old)
        self.assertIn("kernel/a.cpp differs since", self.proof("part_1")[1])
        (self.program.parent / "commit").write_text(old.strip() + "-dirty")
        self.assertIn("built from no clean commit", self.proof("part_1")[1])

    def test_fresh_sets_take_nothing_of_the_old_ones(self):
        self.proof("part_1", "--until", "publish")
        self.commit()
        self.proof("part_1", "--until", "diagnose")
        old = self.public("manifest.json").read_text()
        shutil.rmtree(self.root / "docs/proof")
        (self.root / "kernel/a.cpp").write_text("int b;\n")
        self.commit()
        self.proof("part_1", "--until", "publish")
        self.assertNotEqual(self.public("manifest.json").read_text(), old)
        self.assertFalse((self.root / "build/release/proof/part_1/set_001/diagnosis").exists())

    def test_a_failed_set_is_kept_as_one(self):
        (self.root / "build/fail.txt").write_text("")
        self.proof("part_1", "--until", "publish")
        self.commit()
        self.proof("part_1", "--until", "diagnose")
        (self.root / "build/fail.txt").unlink()
        self.proof("part_1", "--until", "diagnose")
        self.assertEqual([p.name for p in self.public("set_002/diagnosis").iterdir()], ["failed.txt"])
        self.assertEqual(self.public("set_002/diagnosis/failed.txt").read_text(), "case.yaml:61: too few beads\n")

    def test_the_plan_says_what_all_batches_hide(self):
        (self.root / "configs/proof/part.yaml").write_text(
            "study: s.yaml\nsets:\n  - {kind: none, count: 7}\n  - {kind: two, hypotheses: [a, b], strength: [0.5, 1]}\n"
            "  - {kind: decoy, name: clock, camera: c.yaml, count: 2}\n  - {kind: effect, hypothesis: a, strength: [0, 1]}\n")
        done = subprocess.run([sys.executable, str(self.root / "tools/proof.py"), "--plan"], capture_output=True, text=True)
        self.assertEqual(done.stdout.splitlines()[2:], ["| nothing | 14 | 14 |", "| a | 2 | 2 |", "| decoy: clock | 4 | 4 |", "| two: a + b | 2 | 2 |"])
        self.assertFalse((self.root / "docs/proof").exists())
        (self.root / "configs/proof/part.yaml").write_text("sets:\n  - kind: none\n")
        self.assertIn("'  - kind: none' is not", self.proof("--plan")[1])

    def test_no_file_that_makes_recordings_includes_what_judges(self):
        for name in ("make", "record", "draw", "plan"):
            for file in (SOURCE / "studies/challenge").glob(name + ".?pp"):
                for room in proof.JUDGES:
                    self.assertNotIn(room.removeprefix(":(exclude)"), file.read_text(), file)

    def test_the_docs_show_the_plan(self):
        done = subprocess.run([sys.executable, str(SOURCE / "tools/proof.py"), "--plan"], capture_output=True, text=True, check=True)
        self.assertIn(done.stdout, (SOURCE / "docs/challenge.md").read_text())

    def test_what_is_no_part_is_refused(self):
        code, said = self.proof("prat")
        self.assertEqual(code, 1)
        self.assertIn("'prat' is no part; known: part", said)


if __name__ == "__main__":
    unittest.main()
