"""The report is one sound page: tags balanced, nothing fetched, only its own script runs, its data is what was put in.

Usage: read_report.py SAMPLE_REPORT_PROGRAM
"""
import base64
import hashlib
import json
import re
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib
from html.parser import HTMLParser
from pathlib import Path

PROGRAM = sys.argv.pop(1)
VOID = {"meta", "img", "br", "hr", "link", "input"}


class Page(HTMLParser):
    """Keeps a stack of open tags, and what scripts and styles hold."""

    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.open, self.faults, self.links, self.blocks, self.policy, self.styled = [], [], [], [], "", []
        self.ids = []

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        for name in ("href", "src"):
            if name in attributes:
                self.links.append(attributes[name])
        if "style" in attributes or any(name.startswith("on") for name in attributes):
            self.styled.append((tag, attributes))
        if "id" in attributes:
            self.ids.append(attributes["id"])
        if attributes.get("http-equiv") == "Content-Security-Policy":
            self.policy = attributes["content"]
        if tag in ("script", "style"):
            self.blocks.append([tag, attributes, ""])
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):  # <path .../> inside pictures
        for name, value in attributes:
            if name == "href":
                self.links.append(value)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.faults.append(f"</{tag}> at {self.getpos()}")

    def handle_data(self, data):
        if self.open and self.open[-1] in ("script", "style"):
            self.blocks[-1][2] += data


def png_size(data):
    """Width and height; every chunk's checksum is looked at."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, size = 8, None
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        assert zlib.crc32(kind + body) == struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0]
        if kind == b"IHDR":
            size = struct.unpack(">II", body[:8])
        at += 12 + length
    return size


class ReadReport(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([PROGRAM, folder], check=True)
            cls.files = {path.name for path in Path(folder).iterdir()}
            cls.text = (Path(folder) / "report.html").read_bytes().decode("utf-8")
        cls.page = Page()
        cls.page.feed(cls.text)
        cls.page.close()

    def test_tags_are_balanced_and_ids_unique(self):
        self.assertEqual((self.page.faults, self.page.open), ([], []))
        self.assertEqual(len(self.page.ids), len(set(self.page.ids)))

    def test_nothing_is_fetched(self):
        for link in self.page.links:
            local = link.startswith("#") and link[1:] in self.page.ids
            self.assertTrue(local or link.startswith("data:image/png;base64,") or link in self.files, link[:80])
        self.assertNotRegex(self.text, r"@import|url\(|https?://")

    def test_only_its_own_script_and_style_may_run(self):
        self.assertTrue(self.page.policy.startswith("default-src 'none';"))
        self.assertNotIn("unsafe", self.page.policy)
        self.assertEqual(self.page.styled, [], "inline styles and handlers would be blocked")
        kinds = [(tag, attributes.get("type")) for tag, attributes, _ in self.page.blocks]
        self.assertEqual(kinds, [("style", None), ("script", "application/json"), ("script", None)])
        for tag, attributes, content in self.page.blocks:
            if "type" not in attributes:
                digest = base64.b64encode(hashlib.sha256(content.encode()).digest()).decode()
                self.assertIn(f"{tag}-src 'sha256-{digest}'", self.page.policy)

    def test_pictures_are_whole(self):
        pictures = [link.split(",", 1)[1] for link in self.page.links if link.startswith("data:")]
        self.assertGreaterEqual(len(pictures), 10)
        sizes = [png_size(base64.b64decode(picture, validate=True)) for picture in pictures]
        self.assertIn((2, 1), sizes)    # the picture of the bed
        self.assertIn((20, 5), sizes)   # the height map, a pixel a cell
        self.assertIn((256, 1), sizes)  # a colour bar

    def test_plots_carry_numbers_only(self):
        self.assertNotRegex(re.sub(r"base64,[^\"]*|<script.*?</script>", "", self.text, flags=re.S), r"(?<![a-z])(nan|inf)(?![a-z])")

    def test_view_holds_the_bed(self):
        data = json.loads(self.page.blocks[1][2])
        self.assertEqual((data["grains"], data["all_grains"], data["triangles"]), (3, 3, 1))
        words = lambda name: struct.unpack(f"<{len(base64.b64decode(data[name])) // 2}H", base64.b64decode(data[name]))
        centre = [data["low"][i % 3] + data["size"][i % 3] * q / 65535 for i, q in enumerate(words("centre"))]
        for found, put_in in zip(centre, [50, 20, -40, 150, 30, -80, 250, 10, -90]):
            self.assertAlmostEqual(found, put_in, delta=max(data["size"]) / 65535)
        self.assertAlmostEqual(data["largest_radius"] * words("radius")[1] / 65535, 6.5, delta=1e-3)
        self.assertEqual(struct.unpack("<3I", base64.b64decode(data["triangle"])), (0, 1, 2))
        self.assertAlmostEqual(data["plate_top"], -120)


if __name__ == "__main__":
    unittest.main(verbosity=2)
