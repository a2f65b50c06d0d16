"""Pages from outside of docs/, and links between pages and to the repository; a hook of mkdocs."""

from __future__ import annotations

import posixpath
import re
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.plugins import get_plugin_logger
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

REPOSITORY = "https://github.com/vibrissa/vibrissa"
ROOT = Path(__file__).resolve().parents[2]
log = get_plugin_logger("links")

# Files of the repository that are pages, by the names of these.
ELSEWHERE = {
    "index.md": "README.md",
    "python.md": "python/README.md",
    "contributing.md": "CONTRIBUTING.md",
    "changelog.md": "CHANGELOG.md",
    "playground.md": "docs/site/playground.md",
    "api-python.md": "docs/site/api-python.md",
    "api-rust.md": "docs/site/api-rust.md",
    "site.css": "docs/site/site.css",
}
# A folder stands for its README.
FOLDERS = {"python": "python.md", "examples/playground": "playground.md"}
PAGES = FOLDERS | {file: page for page, file in ELSEWHERE.items()}

# The end of a link in Markdown: `](there)`, or `[name]: there`.
LINK = re.compile(r"(\]\(|^\[[^\]\n]+\]: +)([^\s)]+)", re.MULTILINE)
# Code within a line: a bar in it needs a backslash on the code host, if it is in a table, and here must have none.
CODE = re.compile(r"`[^`\n]+`")
# The words of rustdoc behind the name of a language.
FENCE = re.compile(r"^(```[a-z]+),\S+$", re.MULTILINE)


def on_files(files: Files, config: MkDocsConfig) -> Files:
    for page, file in ELSEWHERE.items():
        files.append(File.generated(config, page, abs_src_path=str(ROOT / file)))
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    source = page.file.src_uri
    origin = ELSEWHERE.get(source, f"docs/{source}")

    def moved(link: re.Match[str]) -> str:
        return link[1] + _link(link[2], origin, source, files)

    markdown = CODE.sub(lambda code: code[0].replace(r"\|", "|"), FENCE.sub(r"\1", markdown))
    return LINK.sub(moved, markdown)


def _link(there: str, origin: str, source: str, files: Files) -> str:
    """A link of the file ``origin`` as the page ``source`` needs it: to a page, or else to the repository."""
    if there.startswith(REPOSITORY):
        parts = re.fullmatch(r"/(?:blob|tree|raw)/main/([^#]*)(#.*)?", there.removeprefix(REPOSITORY))
        if not parts:
            return there
        path, anchor = parts[1].rstrip("/"), parts[2] or ""
    elif re.match(r"[a-z]+:|#", there):
        return there
    else:
        path, _, anchor = there.partition("#")
        path, anchor = posixpath.normpath(posixpath.join(posixpath.dirname(origin), path)), anchor and f"#{anchor}"
    if not (ROOT / path).exists():
        log.warning(f"{origin}: {there} leads to {path}, which is not in the repository")
        return there
    page = PAGES.get(path, path.removeprefix("docs/"))
    if files.get_file_from_path(page) is not None:
        return posixpath.relpath(page, posixpath.dirname(source) or ".") + anchor
    return f"{REPOSITORY}/{'tree' if (ROOT / path).is_dir() else 'blob'}/main/{path}{anchor}"
