"""The manual page: every command and option stands in it, and troff takes it without a warning."""
import re
import shutil
import subprocess
import unittest

from support import CliTest


def plain(troff):
    """What a reader sees of the page's own escapes."""
    for escape, text in ((r"\-", "-"), (r"\(dq", '"'), (r"\(aq", "'"), (r"\(ti", "~"), (r"\(ha", "^"), (r"\(ga", "`"), (r"\(rs", "\\"), (r"\&", "")):
        troff = troff.replace(escape, text)
    return re.sub(r"\\\[u([0-9A-F]{4,5})\]", lambda found: chr(int(found.group(1), 16)), troff)


class Manual(CliTest):
    def setUp(self):
        super().setUp()
        self.page = self.succeed("manual").stdout

    def test_sections_commands_options_and_exit_codes(self):
        text = plain(self.page)
        self.assertTrue(self.page.startswith(".TH MILLSCOPE 1 "))
        for section in ("NAME", "SYNOPSIS", "DESCRIPTION", "COMMANDS", "USAGE", '"EXIT STATUS"', '"SEE ALSO"'):
            self.assertIn(f"\n.SH {section}\n", self.page)
        overview = self.succeed("--help").stdout
        for command in re.findall(r"^  (\w+) +\S", overview.split("COMMAND …")[1].split("'millscope COMMAND")[0], re.M):
            self.assertRegex(text, rf'(?m)^\.SS "millscope {command}[ "]')
            for option in re.findall(r"^  (?:-\w \[ )?(--[\w-]+)", self.succeed(command, "--help").stdout, re.M):
                self.assertIn(option, text)
        for code in range(5):
            self.assertIn(f".TP\n\\fB{code}\\fR\n", self.page)

    def test_plain_letters_only(self):
        self.assertTrue(self.page.isascii())
        for line in self.page.splitlines():
            self.assertRegex(line, r"^(\.(TH|SH|SS|TP|PP|RS|RE|nf|fi|B|I|br)\b|[^.']|$)")

    @unittest.skipUnless(shutil.which("groff"), "groff is not installed")
    def test_troff_takes_it(self):
        result = subprocess.run(["groff", "-man", "-Tutf8", "-ww", "-P-c"], input=self.page, capture_output=True, text=True, encoding="utf-8", check=True)
        self.assertEqual(result.stderr, "")
        shown = re.sub(".\b", "", result.stdout)
        for words in ("MILLSCOPE(1)", "millscope run CASE.yaml -o OUT", "--threads N", "--help", "EXIT STATUS"):
            self.assertIn(words, shown)


if __name__ == "__main__":
    unittest.main()
