#!/usr/bin/env python3
"""The checks of the documentation find each kind of fault in a small tree, and nothing in a sound one."""

import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
sys.path[:0] = [str(folder) for folder in Path(__file__).resolve().parents[:2]]
import check_docs  # noqa: E402
import check_sentences  # noqa: E402
from small_tree import SmallTreeTest  # noqa: E402

HELP = {
    "": "usage: millscope COMMAND …\n\n  run        simulate a case\n  pept       recordings\n  geometry   liners\n  completion of words\n\n"
        "'millscope COMMAND --help' explains one.\n\nExample:\n  millscope run a.yaml\n",
    "completion": "usage: millscope completion SHELL\n\nOptions:\n  --help   this page\n",
    "run": "usage: millscope run CASE.yaml -o OUT\n\nOptions:\n  --threads N   threads\n  --set a=b     replace\n",
    "pept": "usage: millscope pept ACTION …\n\n  inspect      how good\n  camera       the camera\n",
    "pept inspect": "usage: millscope pept inspect RECORDING\n\nOptions:\n  --json   print JSON\n",
    "pept camera": "usage: millscope pept camera FILE\n\nOptions:\n  --force   overwrite\n",
    "geometry": "usage: millscope geometry export|report FILE\n\n  ACTION       export or report\n\nOptions:\n  --unit U   unit\n",
}

SOUND = {
    "README.md": "# Title\n\nSee [cases](docs/cases.md#numbers-and-files) and [a file](configs/demo.yaml), or [elsewhere](https://example.org/x).\n\n"
                 "    millscope run configs/demo.yaml -o out --threads 2 && cmake --build b     # not --this\n"
                 "    millscope geometry export configs/demo.yaml -o configs/made.stl\n    millscope pept inspect a.a \\\n        --json\n\n"
                 "| `millscope run CASE.yaml` | simulates, `--threads N` |\n",
    "docs/cases.md": "# Writing\n\n## Numbers and `files`\n\nUse `millscope pept inspect|camera FILE` with `--json`, `configs/{demo,other}.yaml`,\n"
                     "`configs/made.stl` and `millscope frames`.\n\n```yaml\n# no heading\na: 1\n```\n",
    "docs/commands.md": "# Commands\n\n| `run CASE` |\n| `geometry export`, `geometry report` |\n| `pept inspect` |\n| `completion` |\n",
    "configs/demo.yaml": "a: 1\n",
    "CONTRIBUTING.md": "| `tests/dem`, `tests/run` | motion |\n",
    "tests/dem/CMakeLists.txt": "",
    "tests/run/CMakeLists.txt": "",
    "configs/other.yaml": "a: 1\n",
    "mkdocs.yml": "nav:\n  - Cases: cases.md\n  - Commands: commands.md\n",
}

# (file, text that is added, part of the only message)
WRONG = [
    ("docs/cases.md", "[gone](gone.md)\n", "link to gone.md: there is no such file"),
    ("README.md", "[up](../../etc/passwd)\n", "there is no such file"),
    ("docs/cases.md", "![picture](picture.png)\n", "there is no such file"),
    ("docs/cases.md", "[here](#not-here)\n", "has no such heading"),
    ("README.md", "[there](docs/cases.md#no-heading)\n", "has no such heading"),
    ("docs/cases.md", "# One — two\n\n[there](#one--two)\n", "differs between forge and site"),
    ("docs/cases.md", "    millscope walk configs/demo.yaml\n", "'millscope walk' is no command; known: run, pept, geometry, completion"),
    ("docs/cases.md", "Use `millscope pept erase FILE`.\n", "'millscope pept erase' is no action; known: inspect, camera"),
    ("docs/cases.md", "Use `millscope geometry mend FILE`.\n", "'millscope geometry mend' is no action"),
    ("docs/cases.md", "    millscope run a.yaml --treads 2\n", "'millscope run' has no --treads"),
    ("docs/cases.md", "    millscope run a.yaml \\\n        --json\n", "'millscope run' has no --json"),
    ("docs/cases.md", "    millscope pept inspect a.a --force\n", "'millscope pept' has no --force"),
    ("docs/cases.md", "```sh\ncd x && build/release/bin/millscope run a.yaml --treads=2\n```\n", "'millscope run' has no --treads"),
    ("docs/cases.md", "With `--treads 2`.\n", "no command of millscope has --treads"),
    ("docs/cases.md", "| `run CASE.yaml` | `--json` |\n", "'millscope run' has no --json"),
    ("docs/cases.md", "| `pept camera FILE` | `--json` |\n", "'millscope pept' has no --json"),
    ("docs/cases.md", "See `configs/gone.yaml`.\n", "there is no configs/gone.yaml"),
    ("docs/cases.md", "See `configs/{demo,gone}.yaml`.\n", "there is no configs/gone.yaml"),
    ("CONTRIBUTING.md", "| `tests/gone` | gone |\n", "the table of tests has tests/gone, which is not there"),
    ("tests/new/CMakeLists.txt", "add_test()\n", "tests/new is not in the table of tests"),
    ("docs/lost.md", "# Lost\n", "docs/lost.md is not in nav"),
    ("mkdocs.yml", "  - Gone: gone.md\n", "nav has gone.md"),
]


class DocumentationCheck(SmallTreeTest):
    sound = SOUND

    def setUp(self):
        super().setUp()
        self.help = check_docs.Help(lambda words: HELP[" ".join(words)])

    def faults(self):
        return list(check_docs.check_all(self.root, self.help))

    def test_help_is_understood(self):
        self.assertEqual(self.help.commands, ["run", "pept", "geometry", "completion"])
        self.assertEqual(self.help.actions, {"run": [], "pept": ["inspect", "camera"], "geometry": ["export", "report"], "completion": []})
        self.assertEqual(self.help.options["pept", "camera"], {"--force"})

    def test_sound_pages_pass(self):
        self.assertEqual(self.faults(), [])

    def test_a_command_without_a_row_is_found(self):
        self.write("docs/commands.md", SOUND["docs/commands.md"].replace("| `pept inspect` |\n", ""))
        self.assertEqual(self.faults(), ["docs/commands.md: 'millscope pept' has no row in the table; add one"])

    def test_each_fault_is_found_alone(self):
        for name, text, message in WRONG:
            with self.subTest(text):
                before = SOUND.get(name, "")
                self.write(name, before + "\n" + text)
                found = self.faults()
                if before:
                    self.write(name, before)
                else:
                    (self.root / name).unlink()
                self.assertEqual(len(found), 1, found)
                self.assertIn(message, found[0])


# A page whose sentences have 3, 4, 5, 3 and 6 words; what else stands there does not count.
PLAIN = """# A heading of many words that would spoil the average of this page, but headings do not count

Run `millscope run case.yaml -o out`. See [the long page of cases](cases.md#a-very-long-anchor-of-many-words).
- one item of a
  list
- and one more

| a table | whose many words do not count, as nobody reads a table from its beginning to its end |
|---|---|

```
code has as many words as it likes, and it likes many words
```
    so has this kind of code, which begins with four spaces

Eq. 4 holds at 0.5 % of power.
"""


class SentencesCheck(SmallTreeTest):
    sound = {"README.md": PLAIN, **{name: "Many words. " + "word " * 99 for name in check_sentences.WRITTEN}}

    def faults(self):
        return list(check_sentences.check(self.root))

    def test_words_are_counted(self):
        counted = check_sentences.measured(self.root)["README.md"]
        self.assertEqual([(words, line) for words, line, _ in counted], [(2, 3), (6, 3), (5, 4), (3, 6), (7, 16)])

    def test_a_sound_page_and_those_that_programs_write_pass(self):
        self.assertEqual(self.faults(), [])

    def test_a_long_sentence_is_found(self):
        self.write("README.md", PLAIN + "\nBut " + "very " * 39 + "long. Short.\n")
        self.assertEqual(self.faults(), ['README.md:18: a sentence of 41 words, at most 40 are allowed; divide it: "But very very very very very very very …"'])
        self.write("README.md", PLAIN + "\nBut " + "very " * 38 + "long. Short.\n")
        self.assertEqual(self.faults(), [])

    def test_a_long_average_is_found(self):
        self.write("docs/a.md", ("A " + "word " * 18 + "more.\n") * 3)
        self.assertEqual(self.faults(), ["docs/a.md: 20.0 words per sentence on average, at most 18 are allowed; one thought a sentence"])

    def test_a_full_stop_within_a_sentence_does_not_end_it(self):
        self.write("docs/a.md", "Read e.g. The Book (Jones et al. 1990, Fig. 3), by A. Smith. It has 3.5 pages! Does it? “It does.” 3 of them.\n")
        self.assertEqual([words for words, _, _ in check_sentences.measured(self.root)["docs/a.md"]], [13, 4, 2, 2, 3])

    def test_an_exception_that_is_gone_is_found(self):
        (self.root / "docs/proof.md").unlink()
        self.assertEqual(self.faults(), ["docs/proof.md: is an exception of check_sentences.py and not there; take it off the list"])


if __name__ == "__main__":
    unittest.main()
