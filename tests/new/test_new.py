"""`millscope new`: what it writes, what it asks, what it refuses and warns of."""
import os
import pty
import re
import shutil
import unittest

from support import COMMAND, PATIENCE, CliTest, tree_of

SMALL = ("--diameter", "150 mm", "--bead-size", "8 mm")  # few beads: quick to check


def beads_in(text):
    return int(re.search(r"^beads +(\d+) ", text, re.M).group(1))


class Writes(CliTest):
    def test_a_folder_that_passes_the_check_and_can_be_moved(self):
        text = self.succeed("new", "my_mill", *SMALL).stdout
        self.assertEqual(sorted(tree_of(self.folder / "my_mill")),
                         ["README.md", "case.yaml", "materials", "materials/glass.yaml", "materials/hdpe.yaml"])
        self.assertIn("millscope check my_mill/case.yaml", text)
        (self.folder / "elsewhere").mkdir()
        shutil.move(self.folder / "my_mill", self.folder / "elsewhere/mine")
        self.assertEqual(beads_in(self.succeed("check", "elsewhere/mine/case.yaml").stdout), beads_in(text))

    def test_the_case_runs(self):
        self.succeed("new", "my_mill", *SMALL, "--seconds", "2 s")
        summary = self.run_case("out", "--set", "time.end_s=0.02", "--set", "time.analyze_from_s=0.01", "--set", "fill.settle_s=0.02",
                                case="my_mill/case.yaml")
        self.assertGreater(summary["particles"], 100)

    def test_what_was_asked_for_is_in_the_case(self):
        self.succeed("new", "my_mill", *SMALL, "--length", "40 mm", "--filling", "25 %", "--speed", "50 rpm", "--direction", "clockwise",
                     "--lifters", "8", "--lifter-height", "5 mm", "--lifter-width", "12 mm", "--lifter-angle", "70 deg", "--bead-material",
                     "nylon", "--liner-material", "nylon", "--seconds", "3 s", "--ends", "closed")
        case = (self.folder / "my_mill/case.yaml").read_text(encoding="utf-8")
        for line in ("length: 40 mm", "filling: 25 %", "speed: 50 rpm", "direction: clockwise", "lifters: 8", "lifter_height: 5 mm",
                     "lifter_width: 12 mm", "lifter_face_angle: 70 deg", "nylon~nylon:", "end_s: 3 s", "end_faces: true", "name: \"my_mill\""):
            self.assertIn(line, case)
        self.assertNotIn("periodic:", case)

    def test_the_number_of_beads_is_that_of_the_filling(self):
        text = self.succeed("new", "my_mill", *SMALL, "--length", "32 mm", "--filling", "30 %").stdout
        by_hand = 0.3 * 150**2 / 4 * 32 * 0.63 * 6 / 8**3  # J pi/4 D^2 L (1 - 0.37) / (pi/6 d^3), in mm
        self.assertEqual(beads_in(text), round(by_hand))

    def test_a_smooth_shell(self):
        self.succeed("new", "my_mill", *SMALL, "--lifters", "0")
        self.succeed("check", "my_mill/case.yaml")

    def test_names_that_are_no_yaml(self):
        for name in ('a "b": #c', "[x], {y}", "null"):
            self.succeed("new", name, *SMALL)
            self.succeed("check", f"{name}/case.yaml")

    def test_a_material_of_ones_own(self):
        self.write("my_steel.yaml", "materials:\n  steel: {density: 7850 kg/m^3, young_modulus: 210 GPa, poisson_ratio: 0.3}\n")
        self.succeed("new", "my_mill", *SMALL, "--bead-material", "my_steel.yaml", "--liner-material", "my_steel.yaml")
        os.remove(self.folder / "my_steel.yaml")
        self.succeed("check", "my_mill/case.yaml")
        self.write("other.yaml", "materials:\n  glass: {density: 1 kg/m^3, young_modulus: 210 GPa, poisson_ratio: 0.3}\n")
        self.assert_one_line(self.millscope("new", "other", *SMALL, "--liner-material", "other.yaml"), "another material is called 'glass'")

    def test_softer_materials_are_softened_less(self):
        factors = []
        for liner in ("glass", "hdpe"):
            self.succeed("new", liner, *SMALL, "--liner-material", liner)
            factors.append(float(re.search(r"^stiffness_factor: (\S+)", (self.folder / liner / "case.yaml").read_text(), re.M).group(1)))
        self.assertLess(factors[0], factors[1])


class Refuses(CliTest):
    def refuse(self, *words, parts):
        before = tree_of(self.folder)
        self.assert_one_line(self.millscope("new", "my_mill", *words), *parts)
        self.assertEqual(before, tree_of(self.folder))

    def test_an_existing_folder_or_file(self):
        (self.folder / "my_mill").mkdir()
        self.refuse(parts=("my_mill exists already", "choose another name"))
        os.rmdir(self.folder / "my_mill")
        os.symlink("nowhere", self.folder / "my_mill")
        self.assert_one_line(self.millscope("new", "my_mill", "--yes"), "exists already")

    def test_no_name_and_no_place(self):
        self.assert_one_line(self.millscope("new"), "FOLDER is missing")
        self.assert_one_line(self.millscope("new", ".."), "names no new folder")
        self.assert_one_line(self.millscope("new", "nowhere/my_mill"), "there is no folder nowhere", "make it first")

    def test_bare_numbers(self):
        for option in ("diameter", "length", "filling", "bead-size", "lifter-height", "lifter-width", "lifter-angle", "seconds"):
            self.refuse(f"--{option}", "0.3", parts=(f"--{option} is '0.3', without a unit", f"e.g. --{option} \""))
        for word in ("75", "75 %"):
            self.refuse("--speed", word, parts=("--speed", "75 %critical"))

    def test_units_of_another_kind(self):
        self.refuse("--diameter", "300 s", parts=("--diameter is '300 s'", "expected: length"))
        self.refuse("--speed", "2 m", parts=("--speed is '2 m'", "angular speed"))
        self.refuse("--filling", "3 mm", parts=("--filling is '3 mm'",))

    def test_what_cannot_be(self):
        self.refuse("--diameter", "300 m", parts=("--diameter", "between 10 mm and 20 m"))
        self.refuse("--bead-size", "200 mm", parts=("--bead-size",))
        self.refuse(*SMALL, "--length", "20 mm", parts=("--length is 0.02 m", "their own images"))
        self.refuse("--filling", "120 %", parts=("--filling",))
        self.refuse("--speed", "-5 rpm", parts=("--speed -5 rpm", "--direction"))
        self.refuse("--direction", "left", parts=("--direction is 'left'", "clockwise"))
        self.refuse("--ends", "open", parts=("--ends is 'open'",))
        self.refuse("--lifters", "2.5", parts=("--lifters is '2.5'",))
        self.refuse("--lifters", "0", "--lifter-height", "5 mm", parts=("--lifter-height: there are no lifters",))
        self.refuse("--lifters", "20", "--lifter-width", "60 mm", parts=("--lifter-width", "overlap"))
        self.refuse("--bead-material", "glas", parts=("did you mean 'glass'",))
        self.refuse("--diameters", "1 m", parts=("did you mean '--diameter'",))

    def test_a_case_that_would_not_run(self):
        self.refuse(*SMALL, "--filling", "99 %", parts=("nothing was written, because the case would not run: my_mill/case.yaml", "fit"))

    def test_a_place_that_cannot_be_written(self):
        if os.geteuid() == 0:
            self.assert_one_line(self.millscope("new", "/proc/my_mill", *SMALL), "/proc/my_mill", code=4)
        else:
            (self.folder / "locked").mkdir(mode=0o500)
            self.assert_one_line(self.millscope("new", "locked/my_mill", *SMALL), "locked/my_mill", code=4)


class Warns(CliTest):
    def warned(self, *words):
        result = self.succeed("new", "my_mill", *words)
        shutil.rmtree(self.folder / "my_mill")
        return result.stderr

    def test_nothing_to_warn_of(self):
        self.assertEqual(self.warned(*SMALL), "")

    def test_in_words(self):
        for words, said in ((("--bead-size", "40 mm"), "larger than a tenth of the mill"),
                            ((*SMALL, "--filling", "51 %"), "more than half of the mill"),
                            ((*SMALL, "--speed", "105 %critical"), "105 % of the critical speed: .*centrifuging"),
                            ((*SMALL, "--speed", "0.7 %critical"), "0.7 % of the critical speed, which no mill is")):
            self.assertRegex(self.warned(*words), f"^millscope: warning: .*{said}")

    def test_too_many_beads(self):
        result = self.succeed("new", "my_mill", "--diameter", "1 m", "--ends", "closed", "--bead-size", "7 mm", "--filling", "40 %")
        self.assertRegex(result.stderr, r"warning: about 1\.1 million beads take days .*--ends periodic")
        self.assertNotIn("wall time", result.stdout)


class Asks(CliTest):
    def converse(self, answers, *words):
        """On a terminal: each answer is typed when a question stands there. Returns the exit code and all that was to be seen."""
        master, slave = pty.openpty()
        process = self.start("new", "my_mill", *words, stdin=slave, stdout=slave, stderr=slave, text=False)
        os.close(slave)
        text, waiting, answered = "", list(answers), 0
        while True:
            try:
                piece = os.read(master, 4096).decode()
            except OSError:  # the other end was closed
                break
            text += piece
            if text.endswith(": ") and len(text) > answered:
                self.assertTrue(waiting, f"one question too many: {text}")
                os.write(master, waiting.pop(0))
                answered = len(text)
        os.close(master)
        return process.wait(timeout=PATIENCE), text

    def test_one_by_one_with_defaults_in_brackets(self):
        code, text = self.converse([b"150\n", b"150 mm\n", b"8 mm\n"] + [b"\n"] * 20, "--lifters", "6", "--speed", "60 %critical")
        self.assertEqual(code, 0, text)
        self.assertIn("[300 mm]: ", text)
        self.assertIn("is '150', without a unit", text)
        self.assertEqual(text.count("inner diameter of the bare shell"), 2)  # asked again
        self.assertNotIn("speed of the mill", text)
        self.assertNotIn("number of lifters", text)
        case = (self.folder / "my_mill/case.yaml").read_text()
        for line in ("diameter: 150 mm", "lifters: 6", "speed: 60 %critical"):
            self.assertIn(line, case)

    def test_the_end_of_the_answers(self):
        code, text = self.converse([b"\n", b"\x04"])
        self.assertEqual(code, 2, text)
        self.assertIn("nothing was written", text)
        self.assertFalse((self.folder / "my_mill").exists())

    def test_yes_asks_nothing_on_a_terminal(self):
        code, text = self.converse([], *SMALL, "--yes")
        self.assertEqual(code, 0, text)
        self.assertNotIn("[", text)

    def test_nothing_is_asked_off_a_terminal(self):
        result = self.succeed("new", "my_mill", *SMALL)
        self.assertNotIn("[", result.stdout)


if __name__ == "__main__":
    unittest.main()
