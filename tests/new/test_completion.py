"""Completion: what the shells are offered, asked of the shells themselves."""
import os
import pathlib
import re
import shutil
import subprocess
import unittest

from support import COMMAND, PATIENCE, CliTest


class Completion(CliTest):
    def shell(self, shell, script):
        """Runs a script in a shell that finds the command first and has read its completion."""
        environment = os.environ | {"PATH": f"{pathlib.Path(COMMAND).resolve().parent}:{os.environ['PATH']}", "HOME": str(self.folder)}
        result = subprocess.run([shell, "-c", script], cwd=self.folder, env=environment, capture_output=True, text=True, timeout=PATIENCE, check=False)
        self.assertEqual(result.stderr, "")
        return result.stdout.splitlines()

    def bash(self, *words):
        quoted = " ".join("'" + word + "'" for word in words)
        return self.shell("bash", f"source <(millscope completion bash); COMP_WORDS=(millscope {quoted}); COMP_CWORD={len(words)}; "
                                  "_millscope; ((${#COMPREPLY[@]})) && printf '%s\\n' \"${COMPREPLY[@]}\" || true")

    def commands(self):
        overview = self.succeed("--help").stdout
        return re.findall(r"^  (\w+) +\S", overview.split("COMMAND …")[1].split("'millscope COMMAND")[0], re.M)

    def test_every_command(self):
        commands = self.commands()
        self.assertIn("new", commands)
        self.assertEqual(self.bash(""), commands)
        self.assertEqual(self.bash("resu"), ["resume"])
        self.assertEqual(self.bash("nothing"), [])

    def test_every_option_of_every_command_and_action(self):
        tried = 0
        for command in self.commands():
            text = self.succeed(command, "--help").stdout
            calls = [[command]]
            if f"usage: millscope {command} ACTION …" in text:
                actions = re.findall(r"^  (\S+) +\S", text.split("'millscope")[0], re.M)
                self.assertEqual(self.bash(command, ""), actions)
                calls = [[command, action] for action in actions]
            for call in calls:
                listed = re.findall(r"^  (?:-\w \[ )?(--[\w-]+)", self.succeed(*call, "--help").stdout, re.M)
                self.assertGreater(len(listed), 0)
                self.assertEqual(self.bash(*call, "--"), listed, call)
                tried += len(listed)
        self.assertGreater(tried, 200)

    def test_actions_kinds_and_choices(self):
        self.assertEqual(self.bash("geometry", "e"), ["export"])
        self.assertEqual(self.bash("plugin", "new", "b"), ["body_force"])
        self.assertEqual(self.bash("completion", ""), ["bash", "zsh", "fish"])
        self.assertEqual(self.bash("run", "--instruction-set", ""), ["v2", "v3", "v4"])
        self.assertEqual(self.bash("run", "--instruction-set", "=", "v3"), ["v3"])  # as bash cuts --instruction-set=v3
        self.assertEqual(self.bash("run", "--instruction-set", "="), ["v2", "v3", "v4"])
        self.assertEqual(self.bash("new", "x", "--bead-material", "gl"), ["glass"])

    def test_plugins(self):
        self.assertEqual(self.bash("describe", "hertz"), ["hertz_mindlin", "hertz_mindlin_deresiewicz"])
        self.assertIn("gravity", self.bash("describe", ""))

    def test_files(self):
        (self.folder / "folder").mkdir()
        self.write("mesh.stl", "")
        self.write("with space.yaml", "")
        self.assertEqual(sorted(self.bash("run", "")), ["case.yaml", "folder", "materials", "with space.yaml"])
        self.assertEqual(sorted(self.bash("resume", "")), ["folder", "materials"])
        self.assertEqual(self.bash("run", "case.yaml", "-o", "f"), ["folder"])
        self.assertIn("mesh.stl", self.bash("geometry", "report", ""))
        self.assertEqual(self.bash("run", "case.yaml", ""), [])  # there is no second file

    def test_an_unknown_shell(self):
        self.assert_one_line(self.millscope("completion", "tcsh"), "no completion for 'tcsh'", "bash, zsh, fish")

    @unittest.skipUnless(shutil.which("fish"), "fish is not installed")
    def test_fish(self):
        def fish(line):
            return [offer.split("\t")[0] for offer in self.shell("fish", f"millscope completion fish | source; complete -C '{line}'")]
        self.assertEqual(fish("millscope resu"), ["resume"])
        self.assertEqual(fish("millscope run ca"), ["case.yaml"])
        self.assertEqual(fish("millscope run --instruction-set=v3"), ["--instruction-set=v3"])

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not installed")
    def test_zsh(self):
        def zsh(*words):
            quoted = " ".join("'" + word + "'" for word in words)
            # What zsh's own completion would be told, printed.
            return self.shell("zsh", "compdef() { }; compset() { }; _files() { print -r -- files $* }\n"
                                     "_describe() { print -rl -- ${(P)2} }\n"
                                     f"source <(millscope completion zsh); words=(millscope {quoted}); CURRENT={len(words) + 1}; _millscope")
        self.assertEqual(zsh("resu"), ["resume:continue a run from its newest checkpoint"])
        self.assertEqual(zsh("geometry", ""), ["export", "report"])
        self.assertEqual(zsh("run", "ca"), ["files -g *.(yaml|yml)"])
        self.assertEqual(zsh("resume", ""), ["files -/"])
        self.assertEqual(zsh("run", "x", "--instruction-set=v3"), ["--instruction-set=v3"])


if __name__ == "__main__":
    unittest.main()
