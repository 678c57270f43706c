"""What `make docs` needs beyond mkdocs: files outside of docs/ that a page links to come along, and CONTRIBUTING.md is a page.

In the repository a page names them from where it stands, as `../configs/demo.yaml`; in the site they lie beside the pages.
"""

import pathlib
import re

from mkdocs.structure.files import File

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGES = ["CONTRIBUTING.md"]                    # of the top level
OUTSIDE = re.compile(r"\]\(\.\./([^)#\s]+)")   # a link from docs/ to the rest of the repository
INSIDE = re.compile(r"\]\(docs/")              # a link from the top level into docs/


def on_files(files, config):
    """Adds the pages of the top level, and whatever the pages of docs/ link to outside of it."""
    linked = set(PAGES)
    for page in pathlib.Path(config["docs_dir"]).rglob("*.md"):
        linked.update(OUTSIDE.findall(page.read_text(encoding="utf-8")))
    for name in sorted(linked):
        if (ROOT / name).is_file():            # one that is not there stays a broken link, which fails the build
            files.append(File(name, str(ROOT), config["site_dir"], config["use_directory_urls"]))
    return files


def on_page_markdown(markdown, page, config, files):
    if page.file.src_uri in PAGES:
        return INSIDE.sub("](", markdown)
    return OUTSIDE.sub(r"](\1", markdown)


def on_page_content(html, page, config, files):
    """A bar in code within a table is escaped in the page, as forges want it; here it is not."""
    return re.sub(r"(?<!<pre>)<code>[^<\n]*</code>", lambda code: code.group().replace("\\|", "|"), html)
