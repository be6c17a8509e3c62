"""Runs the notebooks of this folder, and compares the text that they print with the stored text.

    python run.py                 # all notebooks
    python run.py first_body      # one of them
    python run.py --write         # stores the new outputs, and the pictures of docs/python

A notebook fails if a cell raises, if a cell prints other text than the stored one, or if nothing is printed. Pictures
are not compared, because they depend on the version of matplotlib.
"""

from __future__ import annotations

import argparse
import base64
import sys
import time
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parent
#: Folder of the pictures of cells with the tag "picture", which the documentation shows.
PICTURES = FOLDER.parents[2] / "docs" / "python"
#: Largest size of a stored notebook [bytes].
LARGEST = 300_000


class Mismatch(AssertionError):
    """The text that a notebook printed differs from the stored text."""


def notebooks() -> list[Path]:
    """Return the paths of all notebooks, sorted by name."""
    return sorted(FOLDER.glob("*.ipynb"))


def printed(notebook: Any) -> list[str]:
    """Return the text that each code cell printed, without warnings."""
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    return ["".join(part.text for part in cell.outputs if part.get("name") == "stdout") for cell in cells]


def execute(path: Path) -> Any:
    """Run a notebook in a new kernel, in its folder, and return it with its outputs."""
    import nbclient
    import nbformat

    notebook = nbformat.read(path, as_version=4)
    nbclient.NotebookClient(
        notebook, timeout=None, kernel_name="python3", resources={"metadata": {"path": str(path.parent)}}
    ).execute()
    return notebook


def check(path: Path) -> Any:
    """Run a notebook and return it with its new outputs.

    Raises `Mismatch` if a cell prints other text than the stored one, and `nbclient.exceptions.CellExecutionError` if a
    cell raises.
    """
    import nbformat

    stored = printed(nbformat.read(path, as_version=4))
    notebook = execute(path)
    found = printed(notebook)
    if not any(found):
        raise Mismatch(f"{path.name}: expected printed numbers, found none")
    for index, (new, old) in enumerate(zip(found, stored, strict=True)):
        if new != old:
            raise Mismatch(f"{path.name}, code cell {index}: expected the stored text\n{old}\nfound\n{new}")
    return notebook


def write(path: Path) -> None:
    """Run a notebook and store its outputs, and its pictures for the documentation.

    The picture of a cell with the tag "picture" becomes docs/python/NAME.png with the name of the notebook. The tag
    "picture:OTHER" chooses another name.
    """
    import nbformat

    notebook = execute(path)
    notebook.metadata = {
        "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
        "language_info": {"name": "python"},
    }
    for cell in notebook.cells:
        tags = [tag for tag in cell.metadata.get("tags", []) if tag.split(":")[0] == "picture"]
        cell.metadata = {"tags": tags} if tags else {}
        for tag in tags:
            name = tag.partition(":")[2] or path.stem
            (part,) = (part for part in cell.outputs if "image/png" in part.get("data", {}))
            PICTURES.mkdir(exist_ok=True)
            (PICTURES / f"{name}.png").write_bytes(base64.b64decode(part.data["image/png"]))
    text = nbformat.writes(notebook)
    size = len(text.encode())
    if size > LARGEST:
        raise ValueError(f"{path.name}: expected at most {LARGEST} bytes, given {size}; make the pictures smaller")
    path.write_text(text.rstrip("\n") + "\n", encoding="utf-8")


def main() -> int:
    """Run the notebooks that the command line names."""
    parser = argparse.ArgumentParser(description="Runs notebooks and compares the text that they print.")
    parser.add_argument("names", nargs="*", help="names without .ipynb; default: all")
    parser.add_argument("--write", action="store_true", help="store the new outputs")
    arguments = parser.parse_args()
    known = {path.stem: path for path in notebooks()}
    unknown = [name for name in arguments.names if name not in known]
    if unknown:
        parser.error(f"unknown notebook {unknown[0]!r}, expected one of {', '.join(known)}")
    from nbclient.exceptions import CellExecutionError

    failed = False
    for name in arguments.names or known:
        start = time.perf_counter()
        try:
            (write if arguments.write else check)(known[name])
            result = "written" if arguments.write else "passed"
        except (Mismatch, CellExecutionError) as error:
            failed, result = True, f"FAILED\n{error}"
        print(f"{name}: {result}, {time.perf_counter() - start:.0f} s", flush=True)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
