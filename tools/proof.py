#!/usr/bin/env python3
"""The proof: tools/proof.py [PART …]. Makes the sets of configs/proof/proof.yaml, diagnoses each once, opens the answers last.

All batches go through five steps together. Each may be stopped; the next call goes on from there, in another clone too.

  make     draws a seed from the system, makes the recordings in BUILD/proof and seals the answers. How the program judges may still be
           changed; nobody may look into the sealed file for it
  publish  docs/proof/BATCH: manifest, hashes of the recordings, the answers and the seed in one sealed file, the commit that is put to the
           test. Commit it: nothing is diagnosed before
  diagnose the sets, with a program that is that commit's in all that decides a verdict
  open     the answers, once every set has its diagnosis. Commit the diagnoses before. Then long runs say what the practice would have seen
  score    docs/proof.md, from all batches that are open

The sealed file is compressed, not locked: it keeps an answer from being seen by chance, and the manifest's hashes keep it from being
changed.
"""

import argparse
import collections
import hashlib
import io
import json
import os
import re
import secrets
import shutil
import subprocess
import sys
import tarfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PLAN = ROOT / "configs" / "proof" / "proof.yaml"
SETS = ROOT / "docs" / "proof"
# What cannot change a verdict; all else has to be as it was when the sets were published.
FREE = ["docs", "tests", "tools", "bench", "examples", "*.md", "Makefile", "mkdocs.yml", ".gitignore", "configs/proof/proof.yaml"]
FREE += ["studies/" + room for room in ("report", "new", "compare", "crosscheck")]
FREE += ["studies/challenge/%s.*" % file for file in ("score", "statistics", "tables", "page", "concealment", "read_sets")]
DECIDES = ["."] + [":(exclude)" + path for path in FREE]
# What judges recordings and makes none.
JUDGES = [":(exclude)studies/diagnose/" + room for room in ("naming", "bank", "verdict", "pages")]


class Failure(Exception):
    """Something the user can put right."""


def git(*arguments):
    done = subprocess.run(["git", "-C", str(ROOT)] + list(arguments), capture_output=True, text=True)
    return done.stdout.rstrip("\n") if done.returncode == 0 else None  # a line of porcelain may begin with a blank


def committed(path):
    """Whether git has all of a file or folder as it is."""
    return git("status", "--porcelain", "--", str(path)) == "" and git("ls-files", "--", str(path)) != ""


def read_by(file, known=None):
    """All YAML files that one names, and those that they name."""
    known = set() if known is None else known
    if file not in known:
        known.add(file)
        for name in re.findall(r"[\w./-]+\.yaml", file.read_text()) if file.exists() else []:
            read_by((file.parent / name).resolve(), known)
    return known


def changed_since(commit, until=None, besides=()):
    """Paths that decide verdicts and are not as in a commit: in the working tree, or in another commit. Without those of `besides`."""
    differ = git("diff", "--name-only", commit, *([until] if until else []), "--", *DECIDES, *besides)
    if differ is None:
        raise Failure("commit %s is not in this clone; fetch it" % commit)
    return differ.split() + ([] if until else [line[3:] for line in (git("status", "--porcelain", "--", *DECIDES) or "").splitlines()])


def last_that_decides(challenge):
    """The commit that changed what decides a challenge's verdicts last. What changed since, pages for instance, makes no other program."""
    program = git("log", "-1", "--format=%H", "HEAD", "--", *DECIDES, ":(exclude)configs")
    read = git("log", "-1", "--format=%H", "HEAD", "--", *(str(path) for path in read_by(challenge.resolve()) if ROOT in path.parents))
    return max(filter(None, (program, read)), key=lambda commit: int(git("rev-list", "--count", commit)))


def built_from(binary):
    """The commit that a program was built from, which has to be a clean one."""
    done = subprocess.run([str(binary), "--version"], capture_output=True, text=True)
    found = re.search(r"commit ([0-9a-f]+)(-dirty)?", done.stdout)
    if not found or found.group(2):
        raise Failure("%s was built from no clean commit (%s); commit all changes and build again" % (binary, done.stdout.strip()))
    return found.group(1)


def replace(path, data):
    """Writes a file at once or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    new = path.with_name(path.name + ".new")
    new.write_bytes(data)
    os.replace(new, path)


def read_plan():
    """[(batch, part, challenge)] in the order of the file, which has one line for each part below "parts"."""
    out = []
    for line in PLAN.read_text().splitlines():
        if not line.startswith("  "):
            continue
        part, rest = line.strip().split(":", 1)
        values = dict(item.split(":") for item in rest.strip(" {}").split(","))
        values = {key.strip(): value.strip() for key, value in values.items()}
        for k in range(int(values["batches"])):
            out.append(("%s_%d" % (part, k + 1), part, PLAN.parent / values["challenge"]))
    return out


def without_folders(text):
    """Where files lay on this machine is nobody's business: a path that begins at the root is left with its file's name."""
    return re.sub(r"(?<![\w./])/(?:[^\s/'\"\\:;,()]+/)+", "", text)


def sha256(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def sha256_anywhere(path):
    """Of a recording; of a set's study with the file it includes as named in the clone, for that path hangs on where the build lies."""
    if path.name != "study.yaml":
        return sha256(path)

    def in_clone(quoted):
        file = (path.parent / quoted.group(1)).resolve()
        if ROOT not in file.parents:
            raise Failure("%s: includes %s, which is no file of this clone; remove %s" % (path, file, path.parent.parent))
        return '"%s"' % file.relative_to(ROOT)

    return hashlib.sha256(re.sub(r'"([^"]*)"', in_clone, path.read_text()).encode()).hexdigest()


def hidden_in(challenge):
    """[(what is hidden, of how many sets)] of a challenge, which has one line for each kind of sets."""
    out = []
    for line in challenge.read_text().splitlines():
        if not line.startswith("  - "):
            continue
        found = re.fullmatch(r"  - \{kind: (none|effect|two|outside|decoy)\b(.*)\}", line)
        if not found:
            raise Failure("%s: '%s' is not '  - {kind: …, …}' in one line" % (challenge, line))
        kind, rest = found.groups()
        names = re.search(r"hypothes[ie]s: (\[[^\]]*\]|\w+)", rest) or re.search(r"name: (\w+)", rest)
        what = {"none": "nothing", "effect": "", "two": "two: ", "outside": "outside the list: ", "decoy": "decoy: "}[kind]
        count = re.search(r"count: (\d+)", rest)
        out.append((what + (names.group(1).strip("[]").replace(", ", " + ") if names else ""), int(count.group(1)) if count else 1))
    return out


def show_plan(plan):
    """A table of what is hidden, part by part: sets of all batches."""
    challenges = {part: challenge for _, part, challenge in plan}
    batches = collections.Counter(part for _, part, _ in plan)
    counts = {}
    for part, challenge in challenges.items():
        for what, count in hidden_in(challenge):
            row = counts.setdefault(what, dict.fromkeys(batches, 0))
            row[part] += count * batches[part]
    order = sorted(counts, key=lambda what: (what != "nothing", ":" in what, what.split(":")[0]))
    print("| hidden | %s | all |\n|%s" % (" | ".join("`%s`" % part for part in batches), "---|" * (len(batches) + 2)))
    for what in order:
        print("| %s | %s | %d |" % (what, " | ".join(str(n or "") for n in counts[what].values()), sum(counts[what].values())))


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
        return {str(p.relative_to(self.work)): sha256_anywhere(p) for p in files}

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
        """Answers and seed, compressed into one file of WORK; beside it what was made."""
        data = io.BytesIO()
        with tarfile.open(fileobj=data, mode="w:xz") as tar:
            for answer in sorted((self.work / "answers").glob("set_*.json")):
                tar.add(answer, "answers/" + answer.name)
            info = tarfile.TarInfo("seed.txt")
            info.size = len(str(seed))
            tar.addfile(info, io.BytesIO(str(seed).encode()))
        replace(self.work / "made.json", (json.dumps(self.recordings(), indent=1) + "\n").encode())
        replace(self.work / "sealed.tar.xz", data.getvalue())
        self.forget()

    def makes_others(self, commit):
        """What this commit would make other recordings from than those that are there; nothing: all that differs judges alone."""
        mark = self.work / "commit.txt"
        if not mark.exists():
            return None
        try:
            changed = self.counting(changed_since(mark.read_text(), commit, JUDGES))
        except Failure:
            return "a commit that this clone lacks"
        return "another " + changed[0] if changed else None

    def ensure_made(self):
        """Recordings and sealed answers are in WORK. What another program made is made again, from a new seed. Returns the commit that is put
        to the test."""
        commit = last_that_decides(self.challenge)
        self.check_program(commit)
        changed = self.makes_others(commit)
        if changed:
            print("%s: made anew, for its recordings were made with %s" % (self.name, changed))
        if changed or not (self.work / "commit.txt").exists():
            shutil.rmtree(self.work, ignore_errors=True)
            replace(self.work / "seed.txt", str(secrets.randbelow(9 * 10**15)).encode())
            replace(self.work / "commit.txt", commit.encode())
        if not (self.work / "sealed.tar.xz").exists():
            seed = int((self.work / "seed.txt").read_text())
            if not (self.work / "manifest.json").exists():
                self.make(seed)
            self.seal(seed)
        return commit

    def publish(self):
        commit = self.ensure_made()
        made = json.loads((self.work / "made.json").read_text())
        if self.recordings() != made:
            raise Failure("%s: its recordings are not those that were made; remove %s" % (self.name, self.work))
        if any(self.work.glob("set_*/diagnosis")):
            raise Failure("%s: was diagnosed before it was published; remove %s" % (self.name, self.work))
        new = self.public.with_name(self.name + ".new")
        shutil.rmtree(new, ignore_errors=True)
        new.mkdir(parents=True)
        shutil.copy(self.work / "manifest.json", new)
        shutil.copy(self.work / "sealed.tar.xz", new)
        frozen = {"commit": commit, "made_by": (self.work / "commit.txt").read_text(), "challenge": self.challenge.name, "recordings_sha256": made}
        (new / "frozen.json").write_text(json.dumps(frozen, indent=1) + "\n")
        os.replace(new, self.public)
        print("%s: published in %s, for commit %s; sha256 of its manifest: %s" %
              (self.name, self.public.relative_to(ROOT), commit[:12], sha256(self.public / "manifest.json")))

    def forget(self):
        """Answers and seed lie open nowhere while the sets are diagnosed."""
        shutil.rmtree(self.work / "answers")
        (self.work / "seed.txt").unlink(missing_ok=True)

    def counting(self, paths):
        """Without cases and challenges that this batch does not read."""
        reads = {str(path.relative_to(ROOT)) for path in read_by(self.challenge.resolve()) if ROOT in path.parents}
        return [path for path in paths if not path.startswith("configs/") or path in reads]

    def check_program(self, commit):
        changed = self.counting(changed_since(commit))
        changed += [path for path in changed_since(commit, built_from(self.binary)) if not path.startswith("configs/")]  # read, not built
        if changed:
            raise Failure("%s is for commit %s, and %s differs since; use a clone and a build of that commit, or make fresh sets" %
                          (self.name, commit[:12], changed[0]))

    def unsealed(self):
        with tarfile.open(self.public / "sealed.tar.xz") as tar:
            return {member.name: tar.extractfile(member).read() for member in tar.getmembers()}

    def restore(self):
        """In another clone the recordings are made again, from the sealed seed, and must be the same to the bit."""
        if not (self.work / "manifest.json").exists():
            self.make(int(self.unsealed()["seed.txt"]))
            self.forget()
        if self.recordings() != self.frozen()["recordings_sha256"]:
            raise Failure("%s: its recordings are not those that were published; remove %s" % (self.name, self.work))
        shutil.copy(self.public / "manifest.json", self.work)
        for name in self.names():
            found = Path(name) / "diagnosis" / "diagnosis.json"
            if (self.public / found).exists():
                replace(self.work / found, (self.public / found).read_bytes())

    def frozen(self):
        return json.loads((self.public / "frozen.json").read_text())

    def names(self):
        return [s["set"] for s in json.loads((self.public / "manifest.json").read_text())["sets"]]

    def keep(self):
        """Finished diagnoses, compact, where they are committed; a set that failed keeps its reason, and no later try counts."""
        for name in self.names():
            source, target = self.work / name / "diagnosis", self.public / name / "diagnosis"
            if self.has(name):
                continue
            if (source / "diagnosis.json").exists():
                found = json.loads((source / "diagnosis.json").read_text())
                if "study" in found:
                    found["study"] = "%s/study.yaml" % name
                text = json.dumps(found, separators=(",", ":"), ensure_ascii=False) + "\n"
                replace(target / "diagnosis.json", without_folders(text).encode())
            elif (source / "failed.txt").exists():
                replace(target / "failed.txt", without_folders((source / "failed.txt").read_text()).encode())

    def has(self, name):
        return any((self.public / name / "diagnosis" / file).exists() for file in ("diagnosis.json", "failed.txt"))

    def complete(self):
        return all(self.has(name) for name in self.names())

    def diagnose(self):
        for file in ("manifest.json", "sealed.tar.xz", "frozen.json"):
            if not committed(self.public / file):
                raise Failure("%s: commit %s first: what is put to the test must be known before" %
                              (self.name, self.public.relative_to(ROOT)))
        self.check_program(self.frozen()["commit"])
        self.restore()
        self.keep()
        try:
            self.call("challenge", "run", self.work, "--cache", self.cache, "--quiet")
        finally:
            self.keep()

    def open(self):
        if not committed(self.public):
            raise Failure("%s: commit the diagnoses in %s before the answers are opened" % (self.name, self.public.relative_to(ROOT)))
        new = self.public / "opened.new"
        shutil.rmtree(new, ignore_errors=True)
        for name, data in self.unsealed().items():
            if name != "seed.txt":
                replace(new / name, data)
        os.replace(new / "answers", self.public / "answers")
        new.rmdir()

    def conceal(self):
        """What stands there is kept, so that only what is missing costs anything."""
        self.call("challenge", "conceal", self.challenge, self.public, "--cache", self.cache, "--quiet")

    def opened(self):
        return (self.public / "answers").exists()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part", nargs="*", help="parts or batches (default: all)")
    parser.add_argument("--build", default=ROOT / "build" / "release", type=Path)
    parser.add_argument("--until", choices=["make", "publish", "diagnose", "score"], default="score", help="stop after this step")
    parser.add_argument("--plan", action="store_true", help="say what the batches hide, and do nothing")
    arguments = parser.parse_args()
    plan = read_plan()
    if arguments.plan:
        return show_plan(plan)
    unknown = [p for p in arguments.part if p not in {x for batch in plan for x in batch[:2]}]
    if unknown:
        raise Failure("'%s' is no part; known: %s" % (unknown[0], ", ".join(sorted({part for _, part, _ in plan}))))
    batches = [(Batch(arguments.build.resolve(), name, challenge), part) for name, part, challenge in plan]
    asked = [b for b, part in batches if not arguments.part or part in arguments.part or b.name in arguments.part]
    for batch in asked:
        if not batch.public.exists():
            if arguments.until == "make":
                batch.ensure_made()
            else:
                batch.publish()
    for batch in asked if arguments.until not in ("make", "publish") else []:
        if not batch.complete():
            batch.diagnose()
    for batch in asked if arguments.until == "score" else []:
        if not batch.opened():
            batch.open()
        batch.conceal()
    ready = [str(b.public.relative_to(ROOT)) for b, _ in batches if b.opened()]
    if arguments.until == "score" and ready:
        batches[0][0].call("challenge", "score", *ready, "-o", "docs/proof.md")


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        sys.exit("proof: %s" % failure)
