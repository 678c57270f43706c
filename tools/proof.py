#!/usr/bin/env python3
"""The proof: tools/proof.py [PART …]. Makes the sets of configs/proof/proof.yaml, diagnoses each once, opens the answers last.

A batch of sets goes through five steps. Each may be stopped; the next call goes on from there, in another clone too.

  make     draws a seed from the system, makes the recordings in BUILD/proof
  publish  docs/proof/BATCH: manifest, hashes of the recordings, the answers and the seed in one sealed file, the commit that is put to the
           test. Commit it: nothing is diagnosed before
  diagnose the sets, with a program that is that commit's in all that decides a verdict
  open     the answers, once every set has its diagnosis. Commit the diagnoses before. Then long runs say what the practice would have seen
  score    docs/proof.md, from all batches that are open

The sealed file is compressed, not locked: it keeps an answer from being seen by chance, and the manifest's hashes keep it from being
changed.
"""

import argparse
import hashlib
import io
import json
import secrets
import shutil
import subprocess
import sys
import tarfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PLAN = ROOT / "configs" / "proof" / "proof.yaml"
SETS = ROOT / "docs" / "proof"
# What decides a verdict; the rest of the program may change between two calls.
DECIDES = ["kernel", "sdk", "plugins", "geometry", "analyzers", "configs/proof", "configs/story", "configs/materials", "configs/cameras"] + [
    "studies/" + room for room in ("recording", "trajectory", "inspect", "analysis", "camera", "calibrate", "campaign", "diagnose", "doe",
                                   "engine")]


class Failure(Exception):
    """Something the user can put right."""


def git(*arguments):
    done = subprocess.run(["git", "-C", str(ROOT)] + list(arguments), capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else None


def committed(folder):
    """Whether git has all of a folder as it is."""
    return git("status", "--porcelain", "--", str(folder)) == "" and git("ls-files", "--", str(folder)) != ""


def changed_since(commit):
    """Paths that decide a verdict and are not as in a commit."""
    differ = git("diff", "--name-only", commit, "--", *DECIDES)
    if differ is None:
        raise Failure("commit %s is not in this clone; fetch it" % commit)
    return differ.split()


def read_plan():
    """[(batch, part, challenge)] in the order of the file, which has one line for each part."""
    out = []
    for line in PLAN.read_text().splitlines():
        if line.startswith("#") or not line.strip():
            continue
        part, rest = line.split(":", 1)
        values = dict(item.split(":") for item in rest.strip(" {}").split(","))
        values = {key.strip(): value.strip() for key, value in values.items()}
        for k in range(int(values["batches"])):
            out.append(("%s_%d" % (part, k + 1), part, PLAN.parent / values["challenge"]))
    return out


def sha256(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


class Batch:
    """One batch: WORK/BATCH has its recordings, docs/proof/BATCH what is published of it."""

    def __init__(self, build, name, challenge):
        self.binary, self.challenge, self.name = build / "bin" / "millscope", challenge, name
        self.work, self.public = build / "proof" / name, SETS / name
        self.cache = build / "proof" / "cache"

    def call(self, *arguments):
        command = [str(self.binary)] + [str(a) for a in arguments]
        print("  millscope " + " ".join(command[1:]), flush=True)
        if subprocess.run(command, cwd=ROOT).returncode != 0:
            raise Failure("%s: 'millscope %s' failed; see above" % (self.name, " ".join(command[1:3])))

    def recordings(self):
        """{path below WORK/BATCH: sha256} of all that is diagnosed."""
        files = sorted(p for p in self.work.glob("set_*/*") if p.is_file())
        return {str(p.relative_to(self.work)): sha256(p) for p in files}

    def make(self, seed):
        """The seed goes by a file, so that no list of processes shows it."""
        self.work.mkdir(parents=True, exist_ok=True)
        secret = self.challenge.parent / (".%s_seeded.yaml" % self.name)
        text = [("seed: %d" % seed if line.startswith("seed:") else line) for line in self.challenge.read_text().splitlines()]
        secret.write_text("\n".join(text) + "\n")
        try:
            self.call("challenge", "make", secret, "-o", self.work, "--quiet")
        finally:
            secret.unlink()

    def seal(self, seed):
        """Answers and seed, compressed into one file."""
        data = io.BytesIO()
        with tarfile.open(fileobj=data, mode="w:xz") as tar:
            for answer in sorted((self.work / "answers").glob("set_*.json")):
                tar.add(answer, "answers/" + answer.name)
            info = tarfile.TarInfo("seed.txt")
            info.size = len(str(seed))
            tar.addfile(info, io.BytesIO(str(seed).encode()))
        return data.getvalue()

    def publish(self):
        seed_file = self.work / "seed.txt"  # an interrupted make goes on with the same truths
        if not seed_file.exists():
            self.work.mkdir(parents=True, exist_ok=True)
            seed_file.write_text(str(secrets.randbelow(9 * 10**15)))
        seed = int(seed_file.read_text())
        if not (self.work / "manifest.json").exists():
            self.make(seed)
        if git("status", "--porcelain", "--", *DECIDES) != "":
            raise Failure("the program differs from its commit in what decides a verdict; commit it first")
        self.public.mkdir(parents=True, exist_ok=True)
        shutil.copy(self.work / "manifest.json", self.public)
        (self.public / "sealed.tar.xz").write_bytes(self.seal(seed))
        frozen = {"commit": git("rev-parse", "HEAD"), "challenge": self.challenge.name, "recordings_sha256": self.recordings()}
        (self.public / "frozen.json").write_text(json.dumps(frozen, indent=1) + "\n")
        print("%s: published in %s, for commit %s; sha256 of its manifest: %s" %
              (self.name, self.public.relative_to(ROOT), frozen["commit"][:12], sha256(self.public / "manifest.json")))

    def unsealed(self):
        with tarfile.open(self.public / "sealed.tar.xz") as tar:
            return {member.name: tar.extractfile(member).read() for member in tar.getmembers()}

    def restore(self):
        """In another clone the recordings are made again, from the sealed seed, and must be the same to the bit."""
        if not (self.work / "manifest.json").exists():
            self.make(int(self.unsealed()["seed.txt"]))
        if self.recordings() != self.frozen()["recordings_sha256"]:
            raise Failure("%s: its recordings are not those that were published; remove %s" % (self.name, self.work))
        shutil.copy(self.public / "manifest.json", self.work)
        for found in self.public.glob("set_*/diagnosis/*.*"):
            target = self.work / found.relative_to(self.public)
            if not target.exists():
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(found, target)

    def frozen(self):
        return json.loads((self.public / "frozen.json").read_text())

    def names(self):
        return [s["set"] for s in json.loads((self.public / "manifest.json").read_text())["sets"]]

    def keep(self):
        """Finished diagnoses, compact, where they are committed; a set that failed keeps its reason, and is not tried again."""
        for name in self.names():
            source, target = self.work / name / "diagnosis", self.public / name / "diagnosis"
            if target.exists():
                continue
            if (source / "diagnosis.json").exists():
                target.mkdir(parents=True)
                found = json.loads((source / "diagnosis.json").read_text())
                (target / "diagnosis.json").write_text(json.dumps(found, separators=(",", ":"), ensure_ascii=False) + "\n")
            elif (source / "failed.txt").exists():
                target.mkdir(parents=True)
                shutil.copy(source / "failed.txt", target)

    def complete(self):
        return self.public.exists() and all((self.public / n / "diagnosis").exists() for n in self.names())

    def diagnose(self):
        if not committed(self.public):
            raise Failure("%s: commit %s first: what is put to the test must be known before" % (self.name, self.public.relative_to(ROOT)))
        changed = changed_since(self.frozen()["commit"])
        if changed:
            raise Failure("%s is for commit %s, and %s differs since; diagnose it with a clone of that commit, or make fresh sets" %
                          (self.name, self.frozen()["commit"][:12], changed[0]))
        self.restore()
        try:
            self.call("challenge", "run", self.work, "--cache", self.cache, "--quiet")
        finally:
            self.keep()

    def open(self):
        if not committed(self.public):
            raise Failure("%s: commit the diagnoses in %s before the answers are opened" % (self.name, self.public.relative_to(ROOT)))
        (self.public / "answers").mkdir()
        for name, data in self.unsealed().items():
            if name != "seed.txt":
                (self.public / name).write_bytes(data)

    def conceal(self):
        if not (self.public / "concealment.json").exists():
            self.call("challenge", "conceal", self.challenge, self.public, "--cache", self.cache, "--quiet")

    def opened(self):
        return (self.public / "answers").exists()

    def step(self, until):
        """Goes on with this batch as far as may be."""
        if not self.public.exists():
            self.publish()
        if until == "publish":
            return
        if not self.complete():
            self.diagnose()
        if until == "diagnose":
            return
        if not self.opened():
            self.open()
        self.conceal()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part", nargs="*", help="parts or batches (default: all)")
    parser.add_argument("--build", default=ROOT / "build" / "release", type=Path)
    parser.add_argument("--until", choices=["publish", "diagnose", "score"], default="score", help="stop after this step")
    arguments = parser.parse_args()
    plan = read_plan()
    unknown = [p for p in arguments.part if p not in {x for batch in plan for x in batch[:2]}]
    if unknown:
        raise Failure("'%s' is no part; known: %s" % (unknown[0], ", ".join(sorted({part for _, part, _ in plan}))))
    batches = [(Batch(arguments.build.resolve(), name, challenge), part) for name, part, challenge in plan]
    for batch, part in batches:
        if not arguments.part or part in arguments.part or batch.name in arguments.part:
            batch.step(arguments.until)
    ready = [str(b.public.relative_to(ROOT)) for b, _ in batches if b.opened()]
    if arguments.until == "score" and ready:
        batches[0][0].call("challenge", "score", *ready, "-o", "docs/proof.md")


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        sys.exit("proof: %s" % failure)
