#!/usr/bin/python3
"""Every file that a Markdown page of the project links to is there, and no page says that it is unfinished."""

import os
import pathlib
import re
import sys
import unittest

TOP = pathlib.Path(os.environ.get("PELLICLE_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
LINK = re.compile(r"\]\(([^)\s#]+)(?:#[^)]*)?\)")
PAGES = sorted([*TOP.glob("*.md"), *TOP.glob("docs/**/*.md"), *TOP.glob("cases/**/*.md")])


class Documents(unittest.TestCase):
    def test_links_lead_somewhere(self):
        missing = []
        for page in PAGES:
            for target in LINK.findall(page.read_text(encoding="utf-8")):
                if "://" not in target and not (page.parent / target).exists():
                    missing.append(f"{page.relative_to(TOP)}: {target}")
        self.assertEqual(missing, [])

    def test_nothing_is_left_to_be_filled(self):
        left = [str(page.relative_to(TOP)) for page in PAGES if "TO BE FILLED" in page.read_text(encoding="utf-8")]
        self.assertEqual(left, [])


if __name__ == "__main__":
    sys.exit(unittest.main())
