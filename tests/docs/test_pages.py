"""docs/plugins.md says what the plugins say, and the documentation builds to a site that needs nothing from elsewhere."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("MILLSCOPE_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
COMMAND = os.environ.get("MILLSCOPE", str(SOURCE / "build/release/bin/millscope"))
MKDOCS = shutil.which("mkdocs")
RESOURCE = re.compile(r"<(?:script|img|iframe|source)[^>]*\ssrc=\"([^\"]*)\"|<link[^>]*\shref=\"([^\"]*)\"", re.I)
ANCHOR = re.compile(r"<a[^>]*\shref=\"([^\"]*)\"", re.I)


class PluginReference(unittest.TestCase):
    def reference(self, *words):
        return subprocess.run([sys.executable, "-B", SOURCE / "tools/plugin_reference.py", "--millscope", COMMAND, *words], capture_output=True, text=True)

    def test_the_page_is_up_to_date(self):
        done = self.reference("--check")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_a_page_that_is_out_of_date_is_found_and_mended(self):
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder) / "plugins.md"
            text = (SOURCE / "docs/plugins.md").read_text()
            page.write_text(text.replace("### hertz_mindlin", "### hertz_mindlen"))
            done = self.reference("--check", "--page", page)
            self.assertEqual(done.returncode, 1)
            self.assertIn("+### hertz_mindlin", done.stdout)
            self.assertIn("plugins.md is out of date; write it again with: tools/plugin_reference.py", done.stdout)
            self.assertEqual(self.reference("--page", page).returncode, 0)
            self.assertEqual(page.read_text(), text)

    def test_a_command_that_fails_is_told(self):
        done = subprocess.run([sys.executable, "-B", SOURCE / "tools/plugin_reference.py", "--millscope", "false", "--check"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("'false plugins' failed", done.stderr)


@unittest.skipUnless(MKDOCS, "mkdocs is not installed: tools/install_packages.sh docs")
class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.site = pathlib.Path(cls.folder.name) / "site"
        cls.built = subprocess.run([MKDOCS, "build", "--strict", "--quiet", "--config-file", SOURCE / "mkdocs.yml", "--site-dir", cls.site],
                                   capture_output=True, text=True)
        cls.pages = {p: p.read_text() for p in cls.site.rglob("*.html")}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_it_builds_without_a_warning(self):
        self.assertEqual((self.built.returncode, self.built.stdout + self.built.stderr), (0, ""))
        self.assertGreaterEqual(len(self.pages), len(list((SOURCE / "docs").glob("*.md"))))

    def test_nothing_is_loaded_from_elsewhere(self):
        for page, text in self.pages.items():
            for found in RESOURCE.finditer(text):
                target = found.group(1) or found.group(2)
                with self.subTest(page=page.name, target=target):
                    self.assertNotRegex(target, r"^(?:[a-z]+:)?//")
        for style in self.site.rglob("*.css"):
            self.assertNotRegex(style.read_text(), r"(?:@import|url\()\s*[\"']?(?:https?:)?//", style.name)

    def test_every_file_that_a_page_names_is_there(self):
        for page, text in self.pages.items():
            if page.name == "404.html":  # is served from anywhere, so its addresses begin at the host
                continue
            for found in [a or b for a, b in RESOURCE.findall(text)] + ANCHOR.findall(text):
                path, _, anchor = found.partition("#")
                if re.match(r"[a-z]+:", path) or not path and not anchor:
                    continue
                with self.subTest(page=page.name, target=found):
                    file = (page.parent / path).resolve() if path else page
                    self.assertTrue(file.exists())
                    if anchor and file in self.pages and not anchor.startswith("mkdocs"):
                        self.assertTrue(f'id="{anchor}"' in self.pages[file], f"{file.name} has no heading for #{anchor}")

    def test_no_markup_is_left_in_the_text(self):
        for page, text in self.pages.items():
            body = re.sub(r"<pre>.*?</pre>|<code>.*?</code>|<script.*?</script>", "", text, flags=re.S)
            with self.subTest(page=page.name):
                self.assertNotRegex(body, r"\n\|[- |:]+\|\n|\]\([a-z_]+\.md|```")
                self.assertNotRegex("".join(re.findall(r"<code>(.*?)</code>", text, flags=re.S)), r"\\\|")


if __name__ == "__main__":
    unittest.main()
