#!/usr/bin/env python3
"""Renders every scene file below some folders with default looks, and writes a table and a contact sheet.

    cargo build --release --package xtask
    docs/files/make.py target/release/xtask ../shared/scenes/peers --table README.md --sheet peers.jpg
    docs/files/make.py target/release/xtask ../shared/scenes/materials --sheet materials.jpg --before OTHER/xtask

Needs Pillow. Where files cannot be rendered, the sheet has a grey field and the table the error.
"""

import argparse
import subprocess
import tempfile
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

SIZE = (160, 120)
LABEL = 18
# What every model without lamps and cameras has said of it is not worth a line.
USUAL = ("cameras: the scene has no camera", "lights: the scene has no light")


def scenes(folders):
    kinds = {".gltf", ".glb", ".obj"}
    for folder in folders:
        for path in sorted(Path(folder).rglob("*")):
            if path.suffix.lower() in kinds:
                yield path.relative_to(folder), path


def render(program, scene, picture):
    command = [program, "render", scene, "--size", "%dx%d" % SIZE, "--spp", "64", "--tier", "interpreted", "--quiet"]
    done = subprocess.run([*command, "--output", picture], capture_output=True, text=True, timeout=120)
    prefix = f"{scene}: "
    lines = [line.removeprefix("warning: ").removeprefix("error: ") for line in done.stderr.splitlines()]
    return done.returncode, [line.removeprefix(prefix) for line in lines]


def outcome(status, lines):
    if status != 0:
        return "refused"
    return "nothing to render" if any(line.startswith("scene: has nothing") for line in lines) else "rendered"


def row(name, status, lines):
    said = [line for line in lines if not line.startswith(USUAL)]
    more = f" (and {len(said) - 2} more)" if len(said) > 2 else ""
    text = "; ".join(said[:2]).replace("|", "\\|") + more
    return f"| {name} | {outcome(status, lines)} | {text} |"


def draw_sheet(cells, columns, file):
    pictures = max(len(cell[1]) for cell in cells)
    width, height = SIZE[0] * pictures + 6, SIZE[1] + LABEL
    rows = -(-len(cells) // columns)
    sheet = Image.new("RGB", (columns * width, rows * height), (245, 245, 245))
    pen, font = ImageDraw.Draw(sheet), ImageFont.load_default(11)
    for index, (name, paths) in enumerate(cells):
        x, y = index % columns * width + 3, index // columns * height + 2
        for path in paths:
            if path.exists():
                sheet.paste(Image.open(path).convert("RGB"), (x, y))
            else:
                pen.rectangle((x, y, x + SIZE[0] - 1, y + SIZE[1] - 1), fill=(220, 220, 220))
                pen.text((x + 55, y + 52), "refused", fill=(120, 0, 0), font=font)
            x += SIZE[0]
        label = name.name[: SIZE[0] * pictures // 6]
        pen.text((index % columns * width + 5, y + SIZE[1] + 1), label, fill=(0, 0, 0), font=font)
    sheet.save(file, quality=82, optimize=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folders", nargs="+")
    parser.add_argument("--before", help="an older program, whose pictures stand on the left")
    parser.add_argument("--table", help="Markdown file to append rows to")
    parser.add_argument("--sheet", required=True)
    parser.add_argument("--columns", type=int, default=8)
    args = parser.parse_args()
    cells, rows = [], []
    with tempfile.TemporaryDirectory() as folder:
        for index, (name, path) in enumerate(scenes(args.folders)):
            paths = []
            for label, program in [("before", args.before), ("now", args.program)]:
                if program:
                    paths.append(Path(folder) / f"{index}-{label}.png")
                    status, lines = render(program, path, paths[-1])
            cells.append((name, paths))
            rows.append(row(name, status, lines))
        draw_sheet(cells, args.columns, args.sheet)
    if args.table:
        with open(args.table, "a", encoding="utf-8") as file:
            file.write("\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
