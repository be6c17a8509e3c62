"""The notebooks run, their own checks pass, and they print the stored numbers."""

from __future__ import annotations

import importlib.util
import re
import sys
from pathlib import Path
from types import ModuleType

import pytest

FOLDER = Path(__file__).parents[1] / "notebooks"
PATHS = sorted(FOLDER.glob("*.ipynb"))
pytestmark = pytest.mark.notebooks


@pytest.fixture(scope="module")
def runner() -> ModuleType:
    """The program `notebooks/run.py` as a module."""
    for name in ("nbclient", "nbformat", "ipykernel", "matplotlib"):
        pytest.importorskip(name, reason=f"notebooks require {name}: pip install {name}")
    spec = importlib.util.spec_from_file_location("run_notebooks", FOLDER / "run.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def test_folder_has_notebooks() -> None:
    assert len(PATHS) >= 5


@pytest.mark.parametrize("path", PATHS, ids=lambda path: path.stem)
def test_notebook_prints_stored_numbers_and_its_checks_pass(runner: ModuleType, path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    if "fw.sweep" in text:
        pytest.importorskip("pyarrow", reason=f"{path.name} requires pyarrow: pip install fuwafuwa[sweep]")
    notebook = runner.check(path)
    code = [cell.source for cell in notebook.cells if cell.cell_type == "code"]
    assert any("assert " in source for source in code), "a notebook must check its numbers"


@pytest.mark.parametrize("path", PATHS, ids=lambda path: path.stem)
def test_notebook_is_small_and_has_pictures(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert len(text.encode()) <= 300_000
    assert '"image/png"' in text


def test_runner_reports_changed_text(runner: ModuleType, tmp_path: Path) -> None:
    import nbformat
    from nbformat import v4

    cell = v4.new_code_cell("print(6 * 7)", outputs=[v4.new_output("stream", text="41\n")])
    nbformat.write(v4.new_notebook(cells=[cell]), tmp_path / "wrong.ipynb")
    with pytest.raises(runner.Mismatch, match=r"wrong\.ipynb, code cell 0.*\s41\s+found\s+42"):
        runner.check(tmp_path / "wrong.ipynb")


def test_runner_reports_failed_check(runner: ModuleType, tmp_path: Path) -> None:
    import nbformat
    from nbclient.exceptions import CellExecutionError
    from nbformat import v4

    cell = v4.new_code_cell("assert 6 * 7 == 41, 'no'")
    nbformat.write(v4.new_notebook(cells=[cell]), tmp_path / "false.ipynb")
    with pytest.raises(CellExecutionError, match="no"):
        runner.check(tmp_path / "false.ipynb")


def test_code_of_guide_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    guide = FOLDER.parents[2] / "docs" / "python.md"
    if not guide.exists():
        pytest.skip("the guide is in the repository, not in the package")
    pytest.importorskip("PIL", reason="the guide requires Pillow: pip install pillow")
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"^```python\n(.*?)^```", guide.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    assert len(blocks) >= 6
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, str(guide), "exec"), names)
    assert "pieces" in capsys.readouterr().out
    assert (tmp_path / "tear.gif").stat().st_size > 1000
