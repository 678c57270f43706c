"""Every command: help, what it prints, exit codes, progress."""
import json
import os
import pty
import re
import signal
import subprocess
import unittest

from support import CASE, SOURCE, CliTest

COMMANDS = ("new", "run", "resume", "check", "campaign", "describe", "plugins", "schema", "geometry", "plugin", "completion")


class Help(CliTest):
    def test_the_overview_names_every_command_and_the_exit_codes(self):
        text = self.succeed("--help").stdout
        for word in (*COMMANDS, "usage:", "Example:", "Exit codes", "spheres"):
            self.assertIn(word, text)
        for code in ("0 done", "1 internal", "2 bad input", "3 stopped", "4 the output"):
            self.assertIn(code, text)
        self.assertEqual(text, self.succeed("help").stdout)

    def test_each_command_has_usage_options_and_an_example(self):
        for command in COMMANDS:
            for flag in ("--help", "-h"):
                text = self.succeed(command, flag).stdout
                self.assertIn(f"usage: millscope {command}", text)
                self.assertRegex(text, rf"Example:\n  millscope {command}")
                self.assertIn("--help", text)

    def test_the_examples_name_files_that_exist(self):
        for command in COMMANDS:
            for file in re.findall(r"configs/\S+\.yaml", self.succeed(command, "--help").stdout):
                self.assertTrue((SOURCE / file).exists(), file)

    def test_examples_that_need_nothing_run_as_they_stand(self):
        os.symlink(SOURCE / "configs", self.folder / "configs")
        for command in ("describe", "plugins", "geometry", "plugin"):
            example = re.search(r"Example:\n  millscope (.*)", self.succeed(command, "--help").stdout).group(1)
            self.succeed(*example.split())

    def test_version(self):
        self.assertRegex(self.succeed("--version").stdout, r"^millscope \d+\.\d+\.\d+ \(commit ([0-9a-f]{7,}(-dirty)?|not known: built outside a git checkout)\)\n$")

    def test_no_command_prints_the_overview_and_fails(self):
        result = self.millscope()
        self.assertEqual(result.returncode, 2)
        self.assertIn("usage:", result.stdout)


class OtherKind(CliTest):
    """A file of another kind is told apart from one with a misspelt key, whatever its first key is."""
    READERS = {"a case": ("check",), "a study": ("diagnose",), "a challenge": ("challenge", "make"),
               "a list of tasks": ("campaign",), "a recording": ("pept", "inspect")}
    FILES = {"a case": ("demo", "mill10/case", "mill10/slice", "measured_drums/beads6000", "story/mill"),
             "a study": ("mill10/diagnose", "story/study", "drum/study", "proof/faint_study"), "a challenge": ("story/challenge", "proof/a_long"),
             "a list of tasks": ("campaign",), "a recording": ("mill10/recording", "recordings/ctrack", "recordings/table")}

    def test_it_is_told_what_it_is_and_what_reads_it(self):
        for kind, files in self.FILES.items():
            for wanted, command in self.READERS.items():
                for file in files if wanted != kind else ():
                    said = f"configs/{file}.yaml: is {kind}, and {wanted} is wanted here; 'millscope "
                    self.assert_one_line(self.millscope(*command, SOURCE / f"configs/{file}.yaml"), said)
        self.assert_one_line(self.millscope("import", SOURCE / "configs/demo.yaml", "-o", "out"), "is a case, and a mill of another program's files is wanted")
        self.assert_one_line(self.millscope("analyze", SOURCE / "configs/demo.yaml", "-o", "out"), "is a case, and a recording is wanted")
        self.assert_one_line(self.millscope("geometry", "report", SOURCE / "configs/story/study.yaml"), "is a study, and a case is wanted")
        self.assertFalse((self.folder / "out").exists())

    def test_the_right_kind_is_read(self):
        for kind, files in self.FILES.items():
            for file in files:
                done = self.millscope(*self.READERS[kind], SOURCE / f"configs/{file}.yaml")  # those that write lack their -o
                self.assertNotIn("is wanted here", done.stderr)

    def test_a_mill_of_another_program(self):
        self.write("mill.yml", "files: dump_*.txt\naxis: y\ngravity: -z\nmill: {diameter: 300 mm}\n")
        said = "mill.yml: is a mill of another program's files, and a %s is wanted here; 'millscope import' reads such files"
        self.assert_one_line(self.millscope("check", "mill.yml"), said % "case")
        self.assert_one_line(self.millscope("pept", "inspect", "mill.yml"), said % "recording")
        self.assertNotIn("is wanted here", self.millscope("import", "mill.yml", "-o", "out").stderr)

    def test_a_slip_is_told_as_a_slip(self):
        slips = ((("check",), CASE + "conditions: {}\n", "unknown key 'conditions'"),
                 (("pept", "inspect"), "files: run1.a\naxis: {x: x}\n", "unknown key 'axis'; did you mean 'axes'"),
                 (("campaign", "-o", "out"), "schema_version: 1\ncase: case.yaml\nmill: {}\ntime: {}\nsimulations: {}\n", "unknown key 'mill'"))
        for command, text, said in slips:
            self.write("slip.yaml", text)
            self.assert_one_line(self.millscope(*command, "slip.yaml"), said)


class Mistyped(CliTest):
    def test_unknown_command(self):
        self.assert_one_line(self.millscope("rnu", "case.yaml"), "'rnu' is no command", "did you mean 'run'")
        self.assert_one_line(self.millscope("frobnicate"), "known: new, run, resume, check")

    def test_unknown_option(self):
        self.assert_one_line(self.millscope("run", "case.yaml", "-o", "out", "--thread", "2"), "unknown option '--thread'", "did you mean '--threads'")

    def test_missing_and_surplus_words(self):
        self.assert_one_line(self.millscope("run", "case.yaml"), "--output is missing", "usage:")
        self.assert_one_line(self.millscope("run", "-o", "out"), "CASE.yaml is missing", "usage:")
        self.assert_one_line(self.millscope("run", "case.yaml", "other.yaml", "-o", "out"), "too many", "usage:")
        self.assert_one_line(self.millscope("run", "case.yaml", "-o"), "usage:")
        self.assert_one_line(self.millscope("describe"), "PLUGIN is missing")
        self.assert_one_line(self.millscope("resume"), "OUT is missing")
        self.assertFalse((self.folder / "out").exists())

    def test_actions(self):
        self.assert_one_line(self.millscope("geometry", "exprot", "case.yaml"), "'export' and 'report'")
        self.assert_one_line(self.millscope("challenge", "score", "-o", "page.md"), "SETS is missing", "usage: millscope challenge score")
        self.assertFalse((self.folder / "page.md").exists())
        self.assert_one_line(self.millscope("plugin", "old", "contact_law", "x"), "the only action is 'new'")

    def test_threads(self):
        for word in ("0", "-1", "100000", "two", "1.5", ""):
            self.assert_one_line(self.millscope("run", "case.yaml", "-o", "out", f"--threads={word}"), "threads")
        self.assertFalse((self.folder / "out").exists())

    def test_seed(self):
        plan = ("doe", "design", "latin-hypercube", "-f", "A=0:1", "-f", "B=0:1", "--runs", "8")
        for word in ("-1", "1.5", "one", "1 ", "18446744073709551616"):
            self.assert_one_line(self.millscope(*plan, f"--seed={word}"), f"--seed {word}: a seed is a whole number from 0 to 18446744073709551615")
        plans = [self.succeed(*plan, f"--seed={seed}").stdout for seed in ("1", "4294967297", "18446744073709551615")]
        self.assertEqual(plans[0], self.succeed(*plan).stdout)
        self.assertEqual(len(set(plans)), 3)  # none of the 64 bits is dropped

    def test_instruction_set(self):
        self.assert_one_line(self.millscope("plugins", "--instruction-set", "v9"), "v2, v3 or v4")

    def test_full_standard_output(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            result = self.millscope("schema", stdout=full)
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1)


class Listing(CliTest):
    def test_plugins(self):
        text = self.succeed("plugins").stdout
        for word in ("contact_law", "hertz_mindlin", "linear_spring_dashpot", "jkr", "gravity", "mesh", "searched:"):
            self.assertIn(word, text)

    def test_describe(self):
        text = self.succeed("describe", "hertz_mindlin").stdout
        for word in ("hertz_mindlin", "restitution", "static_friction"):
            self.assertIn(word, text)

    def test_describe_json(self):
        self.assertEqual(json.loads(self.succeed("describe", "jkr", "--json").stdout)["name"], "jkr")

    def test_describe_unknown(self):
        self.assert_one_line(self.millscope("describe", "hertz_mindlim"), "did you mean 'hertz_mindlin'")


class Schema(CliTest):
    def setUp(self):
        super().setUp()
        self.schema = json.loads(self.succeed("schema").stdout)

    def test_it_is_a_schema_of_all_sections(self):
        self.assertIn("json-schema.org", self.schema["$schema"])
        self.assertFalse(self.schema["additionalProperties"])
        for line in CASE.splitlines():
            if re.match(r"\w+:", line):
                self.assertIn(line.split(":")[0], self.schema["properties"])

    def test_the_demo_is_valid(self):
        try:
            import jsonschema
            import yaml
        except ImportError:
            self.skipTest("needs the Python modules jsonschema and yaml")
        jsonschema.validate(yaml.safe_load((SOURCE / "configs/demo.yaml").read_text(encoding="utf-8")), self.schema)
        with self.assertRaises(jsonschema.ValidationError):
            jsonschema.validate({"schema_version": 1, "mil": {}}, self.schema)


class Geometry(CliTest):
    def test_export_of_a_case_and_report_of_both(self):
        self.assertIn("triangles", self.succeed("geometry", "export", "case.yaml", "-o", "liner.stl").stdout)
        self.assertTrue((self.folder / "liner.stl").read_text().startswith("solid"))
        for file, unit in (("case.yaml", ()), ("liner.stl", ("--unit", "m"))):
            report = self.succeed("geometry", "report", file, *unit).stdout
            for word in ("triangles", "box", "area"):
                self.assertIn(word, report)

    def test_binary_export(self):
        self.succeed("geometry", "export", "case.yaml", "-o", "liner.stl", "--binary")
        data = (self.folder / "liner.stl").read_bytes()
        self.assertEqual(len(data), 84 + 50 * int.from_bytes(data[80:84], "little"))

    def test_an_existing_file_is_kept_unless_forced(self):
        self.write("liner.stl", "mine")
        result = self.millscope("geometry", "export", "case.yaml", "-o", "liner.stl")
        self.assert_one_line(result, "liner.stl: exists already", "--force")
        self.assertEqual((self.folder / "liner.stl").read_text(), "mine")
        self.succeed("geometry", "export", "case.yaml", "-o", "liner.stl", "--force")
        self.assertTrue((self.folder / "liner.stl").read_text().startswith("solid"))

    def test_a_file_name_is_no_yaml(self):
        for name in ("my #1: liner.stl", "[x], {y} - z.stl", '"quoted" \'twice\' \\ & *.stl', "null.stl"):
            self.succeed("geometry", "export", "case.yaml", "-o", name)
            self.assertIn("triangles", self.succeed("geometry", "report", name, "--unit", "m").stdout)

    def test_a_file_in_another_folder_counts_from_here(self):
        (self.folder / "below").mkdir()
        self.succeed("geometry", "export", "case.yaml", "-o", "below/liner.stl")
        self.assertIn("triangles", self.succeed("geometry", "report", "below/liner.stl", "--unit", "m").stdout)

    def test_refusals(self):
        self.succeed("geometry", "export", "case.yaml", "-o", "liner.stl")
        self.assert_one_line(self.millscope("geometry", "report", "liner.stl", "--unit", "furlong"), "--unit 'furlong'", "known: mm, m, cm, inch")
        self.assertNotIn("command line", self.millscope("geometry", "report", "liner.stl", "--unit", "m\nscale: 2").stderr)
        self.assert_one_line(self.millscope("geometry", "export", "case.yaml"), "--output is missing")
        self.assert_one_line(self.millscope("geometry", "export", "case.yaml", "-o", "x.stl", "--name", "shell"), "no geometry of that name")
        self.assert_one_line(self.millscope("geometry", "report", "missing.stl"), "missing.stl", "check the path")
        self.assert_one_line(self.millscope("geometry", "report", "missing.yaml"), "missing.yaml", "check the path")
        self.assert_one_line(self.millscope("geometry", "report", "case.yaml", "--set", "geometry.liner.lifters=-3"), "lifters")
        result = self.millscope("geometry", "export", "case.yaml", "-o", "nowhere/x.stl")
        self.assert_one_line(result, "nowhere/x.stl", code=4)


class NewPlugin(CliTest):
    def test_scaffold_and_no_overwriting(self):
        text = self.succeed("plugin", "new", "contact_law", "my_law").stdout
        self.assertIn("cmake -B", text)
        for file in ("CMakeLists.txt", "README.md"):
            self.assertTrue((self.folder / "my_law" / file).exists(), file)
        self.assert_one_line(self.millscope("plugin", "new", "contact_law", "my_law"), "my_law")

    def test_refusals(self):
        self.assert_one_line(self.millscope("plugin", "new", "contact_lw", "my_law"), "did you mean 'contact_law'")
        self.assert_one_line(self.millscope("plugin", "new", "contact_law", "My-Law"), "a to z")
        self.assert_one_line(self.millscope("plugin", "new", "contact_law"), "NAME is missing")


class Check(CliTest):
    def test_predictions(self):
        text = self.succeed("check", "case.yaml").stdout
        self.assertRegex(text, r"beads +324 ")
        for word in ("spheres", "time step", "steps", "wall time", "memory", "disk", "Rayleigh"):
            self.assertIn(word, text)
        steps = int(re.search(r"^steps +(\d+)", text, re.M).group(1))
        self.assertEqual(self.run_case("out")["steps"], steps)

    def test_nothing_is_written(self):
        before = sorted(p.name for p in self.folder.iterdir())
        self.succeed("check", "case.yaml")
        self.assertEqual(before, sorted(p.name for p in self.folder.iterdir()))

    def test_quiet(self):
        result = self.succeed("check", "case.yaml", "--quiet")
        self.assertEqual(result.stderr, "")


class Printing(CliTest):
    def test_quiet_prints_nothing(self):
        result = self.succeed("run", "case.yaml", "-o", "out", "--quiet")
        self.assertEqual(result.stdout + result.stderr, "")
        result = self.succeed("resume", "out", "-q", "--set", "time.end_s=0.11")
        self.assertEqual(result.stdout + result.stderr, "")

    def test_plain_lines_off_a_terminal(self):
        result = self.succeed("run", "case.yaml", "-o", "out")
        self.assertIn("summary.json", result.stdout)
        self.assertIn("324 beads", result.stderr)
        self.assertNotRegex(result.stdout + result.stderr, r"[\r\x1b]")
        self.assertTrue(result.stderr.endswith("\n"))

    def on_terminal(self, *words, stop_at=None):
        master, slave = pty.openpty()
        process = self.start(*words, stdout=slave, stderr=slave, text=False, preexec_fn=os.setsid)
        os.close(slave)
        if stop_at:
            self.wait_for(stop_at, process)
            process.send_signal(signal.SIGINT)
        text = b""
        while True:
            try:
                piece = os.read(master, 4096)
            except OSError:  # the other end was closed
                break
            if not piece:
                break
            text += piece
        os.close(master)
        return process.wait(), text.decode()

    def test_one_line_that_is_rewritten_on_a_terminal(self):
        code, text = self.on_terminal("run", "case.yaml", "-o", "out", "--set", "time.end_s=0.2")
        self.assertEqual(code, 0)
        drawn = re.findall(r"\r\x1b\[K([^\r\n]+)", text)
        self.assertTrue(drawn, text)
        for part in (r"M particle-steps/s", r"s per simulated s", r"ETA \d+:\d\d"):
            self.assertRegex(drawn[0], part)
        self.assertLessEqual(len(text.splitlines()), 3 + len(drawn) + 1)  # the head and the end stand on lines of their own
        self.assertIn("done; see out/summary.json", text)

    def test_stopped_on_a_terminal(self):
        code, text = self.on_terminal("run", "case.yaml", "-o", "out", "--set", "time.end_s=5", stop_at="out/vtk/beads_000001.vtp")
        self.assertEqual(code, 3)
        self.assertIn("millscope resume out", text)

    def test_an_error_on_a_terminal_has_its_own_line(self):
        code, text = self.on_terminal("run", "case.yaml", "-o", "out", "--set", "time.step_fraction=1", "--set", "run.allow_unstable=true",
                                      "--set", "time.end_s=5")
        self.assertEqual(code, 2)
        self.assertRegex(text, r"(\n|\x1b\[K)millscope: at t = ")


if __name__ == "__main__":
    unittest.main()
