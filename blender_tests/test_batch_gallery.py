# SPDX-License-Identifier: GPL-3.0-or-later
"""The gallery of a batch, in headless Chromium: what it shows is what results.csv says, whatever stands there."""
from __future__ import annotations

import csv
import json
import shutil
import subprocess
import tempfile
import unittest
from html.parser import HTMLParser
from pathlib import Path

from reachcast.batch.gallery import write_gallery
from reachcast.batch.run import run_batch
from reachcast.batch.store import COLUMNS

BROWSER = "chromium"
ODD = ("</script><script>document.title='broken'</script>", "<img src=x onerror=\"document.title='broken'\">",
       "Schön & 'gut' \"so\" \u2028 \u202e \\u003c ${1} @DATA@ %2e%2e", "line\nbreak, tab\t, <b>bold</b> &amp;")
#: Appended to a copy of the page: clicks, then says in the title what the pictures are.
CLICKS = """<script>
for (const name of %s) document.querySelector(`th[data-column="${name}"] button`).click();
%s
addEventListener("load", () => {
  document.title = [...document.images].map(item => `${item.naturalWidth}x${item.naturalHeight}`).join(" ") || "none";
});
</script>"""


class Page(HTMLParser):
    """Rows of the table as lists of texts, the title, and the addresses of links and pictures."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.rows: list[list[str]] = []
        self.title, self.sources, self.links = "", [], []
        self._cell = self._title = False
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        values = dict(attributes)
        if tag == "tr":
            self.rows.append([])
        elif tag in ("td", "th"):
            self.rows[-1].append("")
            self._cell = True
        elif tag == "title":
            self._title = True
        elif tag == "img":
            self.sources.append(values.get("src", ""))
        elif tag == "a":
            self.links.append(values.get("href", ""))

    def handle_endtag(self, tag: str) -> None:
        if tag in ("td", "th"):
            self._cell = False
        elif tag == "title":
            self._title = False

    def handle_data(self, data: str) -> None:
        if self._cell:
            self.rows[-1][-1] += data
        elif self._title:
            self.title += data

    def column(self, name: str) -> list[str]:
        place = self.rows[0].index(name)
        return [row[place] for row in self.rows[1:]]


class Gallery(unittest.TestCase):
    def setUp(self) -> None:
        if shutil.which(BROWSER) is None:
            self.skipTest(f"{BROWSER} is not installed")
        self.out = Path(tempfile.mkdtemp(prefix="reachcast-gallery-"))
        self.addCleanup(shutil.rmtree, self.out, ignore_errors=True)

    def opened(self, *clicks: str, do: str = "") -> Page:
        """The page after clicks on the headings of these columns and a piece of JavaScript."""
        page = self.out / "clicked.html"
        page.write_text((self.out / "index.html").read_text(encoding="utf-8") + CLICKS % (json.dumps(clicks), do),
                        encoding="utf-8")
        with tempfile.TemporaryDirectory() as profile:
            done = subprocess.run(
                [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={profile}",
                 "--virtual-time-budget=5000", "--dump-dom", page.as_uri()],
                capture_output=True, text=True, encoding="utf-8", timeout=120, check=True)
        return Page(done.stdout)

    def write_results(self, *rows: dict[str, str]) -> None:
        with (self.out / "results.csv").open("w", encoding="utf-8", newline="") as file:
            table = csv.DictWriter(file, COLUMNS, restval="", lineterminator="\n")
            table.writeheader()
            table.writerows(rows)
        write_gallery(self.out)

    def test_a_batch_shows_its_results_and_thumbnails(self) -> None:
        small = {"home": "0 0.42 0.1", "engine": "WORKBENCH", "resolution": "64x48", "outputs": "sheet"}
        table = self.out / "tasks.jsonl"
        table.write_text("".join(json.dumps(row) + "\n" for row in (
            {"id": "near", **small, "target": "0.2 0.45 1.0"}, {"id": "far", **small, "target": "0 0.4 3.5"},
            {"id": "plain", "target": "0.1 0.45 1.0"})))
        run_batch(table, self.out, say=lambda _: None)
        page = self.opened()
        self.assertEqual(page.column("id"), ["near", "far", "plain"])
        self.assertEqual(page.column("status"), ["done", "refused", "done"])
        with (self.out / "results.csv").open(encoding="utf-8", newline="") as file:
            self.assertEqual(page.column("reason"), [row["reason"] for row in csv.DictReader(file)])
        self.assertEqual((page.sources, page.title), (["tasks/near/thumbnail.png"], "64x48"))
        for link in page.links:
            self.assertTrue((self.out / link).exists(), link)
        self.assertIn("tasks/near/sheet.png", page.links)

    def test_the_same_results_give_the_same_bytes(self) -> None:
        self.write_results({"id": "a", "status": "done", "reason": ODD[2]})
        before = (self.out / "index.html").read_bytes()
        write_gallery(self.out)
        self.assertEqual((self.out / "index.html").read_bytes(), before)
        self.assertNotIn(b"http", before)

    def test_odd_characters_are_shown_as_they_are(self) -> None:
        self.write_results(*({"id": text, "status": "bad row", "reason": text} for text in ODD))
        page = self.opened()
        self.assertEqual(page.column("reason"), list(ODD))
        self.assertEqual(page.column("id"), list(ODD))
        self.assertEqual((page.title, page.sources), ("none", []))

    def test_a_click_on_a_heading_sorts_and_another_turns_it_round(self) -> None:
        self.write_results(*({"id": name, "status": "done", "duration_s": seconds}
                             for name, seconds in (("a", "10.5"), ("b", ""), ("c", "9"), ("d", "-1"), ("e", "9.0"))))
        for clicks, expected in (((), "abcde"), (("duration_s",), "dceab"), (("duration_s",) * 2, "acedb"),
                                 (("duration_s", "id"), "abcde"), (("id", "id"), "edcba")):
            with self.subTest(clicks=clicks):
                self.assertEqual("".join(self.opened(*clicks).column("id")), expected)

    def test_what_is_looked_for_is_found(self) -> None:
        self.write_results(*({"id": f"a{number}", "status": "done", "reason": "Too FAR" if number % 2 else ""}
                             for number in range(4)))
        page = self.opened(do="const find = document.getElementById('find'); find.value = 'too far';"
                              "find.dispatchEvent(new Event('input'));")
        self.assertEqual(page.column("id"), ["a1", "a3"])

    def test_thousands_of_rows_are_drawn_as_far_as_one_looks(self) -> None:
        count = 3000
        self.write_results(*({"id": f"n{number}", "status": "done", "duration_s": str(count - number)}
                             for number in range(count)))
        page = self.opened("duration_s")
        self.assertEqual(page.column("id")[:2], [f"n{count - 1}", f"n{count - 2}"])
        self.assertLess(len(page.rows), count / 2)
        page = self.opened("duration_s", do="while (drawn < order.length) drawMore();")
        self.assertEqual(page.column("id"), [f"n{number}" for number in reversed(range(count))])

    def test_without_results_there_is_no_gallery(self) -> None:
        with self.assertRaisesRegex(ValueError, "no results.csv"):
            write_gallery(self.out)


if __name__ == "__main__":
    unittest.main()
