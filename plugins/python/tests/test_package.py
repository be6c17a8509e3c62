"""Stubs, docstrings and the README."""

import ast
import contextlib
import importlib.util
import inspect
import io
import pathlib
import re
import subprocess
import sys

import pytest

import fuwafuwa as fw
from fuwafuwa import _core

README = pathlib.Path(__file__).parents[1] / "README.md"


@pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="mypy is not installed")
def test_stubs_agree_with_the_module():
    command = [sys.executable, "-m", "mypy.stubtest", "fuwafuwa._core", "--concise"]
    found = subprocess.run(command, capture_output=True, text=True)
    assert found.returncode == 0, found.stdout + found.stderr


def test_stub_has_the_docstrings_of_the_module():
    """`python tools/stub_docstrings.py` brings the stub up to date."""
    stub = ast.parse((pathlib.Path(fw.__file__).parent / "_core.pyi").read_text(encoding="utf-8"))
    compared = 0

    def compare(body, owner):
        nonlocal compared
        for node in body:
            if isinstance(node, ast.ClassDef):
                compare(node.body, getattr(owner, node.name))
            elif not isinstance(node, ast.FunctionDef) or node.name.startswith("__"):
                continue
            elif any(isinstance(decorator, ast.Attribute) for decorator in node.decorator_list):
                continue
            found = inspect.getdoc(getattr(owner, node.name))
            assert ast.get_docstring(node) == found, f"{getattr(owner, '__name__', '')}.{node.name}"
            compared += 1

    compare(stub.body, _core)
    assert compared > 400


def test_package_exports_the_whole_module():
    assert set(fw.__all__) >= set(_core.__all__) | {"Film", "__version__"}
    assert (pathlib.Path(fw.__file__).parent / "py.typed").exists()


def public_members():
    for name in fw.__all__:
        thing = getattr(fw, name)
        if name.startswith("__"):
            continue
        yield name, thing
        if inspect.isclass(thing) and thing is not fw.Error:
            for member in vars(thing):
                if not member.startswith("_"):
                    yield f"{name}.{member}", getattr(thing, member)


def test_everything_public_has_a_docstring():
    bare = [name for name, thing in public_members() if not inspect.getdoc(thing)]
    assert bare == []


def test_every_function_has_a_signature():
    for name, thing in public_members():
        if not callable(thing) or name.endswith(("Handle", "View2", "View3")) or thing is fw.Error:
            continue
        constructs = not inspect.isclass(thing) or "__new__" in vars(thing)
        if constructs:
            assert inspect.signature(thing), name


def test_examples_of_the_readme_run():
    examples = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    assert examples
    output = io.StringIO()
    names = {}
    with contextlib.redirect_stdout(output):
        for example in examples:
            exec(example, names)
    split = re.search(r"(\d+) nodes split, (\d+) pieces", output.getvalue())
    assert int(split[1]) > 10 and int(split[2]) > 1
