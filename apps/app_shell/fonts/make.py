#!/usr/bin/env python3
"""Generates the fonts of the game: subsets of M PLUS Rounded 1c, as TrueType.

    pip install fonttools==4.68.0 brotli==1.2.1
    python3 apps/app_shell/fonts/make.py

The typeface comes from npm (`npm pack`) as some 120 slices. The Latin font contains Latin letters, the symbols
below and the title in each language. The Japanese font, which a browser downloads on demand, contains kana, the
kanji of kanji.txt, and every other character in the sources and data of the game. The same input gives the same
bytes.
"""

import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

from fontTools import subset
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib import TTFont

PACKAGE = "@fontsource/m-plus-rounded-1c@5.3.0"
WEIGHTS = {700: "Bold"}

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[2]
# Folders with the texts of the game.
SOURCES = ["game"]
SUFFIXES = {".rs", ".toml"}

SYMBOLS = "←→↑↓↔↕⇧⏎●○◎■□▲△▼▽▶◀◆◇★☆♥♡♪✓※♂♀①②③④⑤⑥⑦⑧⑨∞≠≤≥−√"
# Characters of the title screen, which is shown before a language is chosen.
TITLE = "玉入れ日本語"
LATIN = [
    (0x20, 0x7E),
    (0xA0, 0xFF),
    (0x2010, 0x2027),  # dashes, quotation marks, ellipsis
]
JAPANESE = [
    (0x3000, 0x30FF),  # punctuation, hiragana, katakana
    (0xFF01, 0xFF5E),  # wide Latin, as Japanese keyboards write it
]


def named():
    """Returns the characters that the fonts must contain: symbols, kanji.txt, and all texts of the game."""
    characters = set(SYMBOLS)
    for line in (HERE / "kanji.txt").read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            characters.update(line)
    for folder in (folder for pattern in SOURCES for folder in ROOT.glob(pattern)):
        for file in folder.rglob("*"):
            if file.suffix in SUFFIXES:
                characters.update(file.read_text(encoding="utf-8"))
    return characters - set("\r\n\t")


def within(ranges):
    return {chr(code) for first, last in ranges for code in range(first, last + 1)}


def slices(folder, weight):
    """Returns the slices of a weight, beginning with the Japanese one, which has most characters."""
    japanese = f"m-plus-rounded-1c-japanese-{weight}-normal.woff2"
    others = sorted(folder.glob(f"m-plus-rounded-1c-*-{weight}-normal.woff2"))
    others = [path for path in others if path.name != japanese]
    return [TTFont(path, recalcTimestamp=False) for path in [folder / japanese, *others]]


def add(font, character, other):
    """Copies the outline of a character from another slice of the font."""
    source = other.getBestCmap()[ord(character)]
    name = f"uni{ord(character):04X}"
    pen = TTGlyphPen(None)
    other.getGlyphSet()[source].draw(pen)
    font.setGlyphOrder([*font.getGlyphOrder(), name])
    font["glyf"][name] = pen.glyph()
    font["hmtx"][name] = other["hmtx"][source]
    for table in font["cmap"].tables:
        if table.isUnicode():
            table.cmap[ord(character)] = name


def make(folder, weight, part, characters):
    """Writes a subset of the font in this weight and returns the characters that it contains."""
    font, *others = slices(folder, weight)
    for table in ("vhea", "vmtx"):
        del font[table]
    for character in sorted(characters):
        if ord(character) not in font.getBestCmap():
            having = (other for other in others if ord(character) in other.getBestCmap())
            if other := next(having, None):
                add(font, character, other)

    options = subset.Options()
    options.hinting = False
    options.layout_features = ["kern"]
    options.name_IDs = [0, 1, 2, 4, 6, 13, 14]
    options.notdef_outline = True
    subsetter = subset.Subsetter(options)
    subsetter.populate(text="".join(characters))
    subsetter.subset(font)
    font.flavor = None

    file = HERE / f"MPLUSRounded1c-{WEIGHTS[weight]}-{part}.ttf"
    font.save(file)
    there = {chr(code) for code in font.getBestCmap()}
    print(f"{file.name}: {file.stat().st_size} bytes, {len(there)} characters")
    return there


def main():
    with tempfile.TemporaryDirectory() as folder:
        command = ["npm", "pack", "--silent", "--pack-destination", folder, PACKAGE]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        (archive,) = Path(folder).glob("*.tgz")
        with tarfile.open(archive) as files:
            files.extractall(folder, filter="data")
        (HERE / "OFL.txt").write_bytes(Path(folder, "package/LICENSE").read_bytes())
        must = named()
        latin = within(LATIN) | set(SYMBOLS + TITLE)
        parts = {"latin": latin, "japanese": (must | within(JAPANESE)) - latin}
        for weight in WEIGHTS:
            files = Path(folder, "package/files")
            must -= set().union(*(make(files, weight, *part) for part in parts.items()))
    if absent := must:
        sys.exit("M PLUS Rounded 1c does not have: " + " ".join(sorted(absent)))


if __name__ == "__main__":
    main()
