"""Copy the docstrings of the compiled module into its stub, where editors read them.

`python tools/stub_docstrings.py` rewrites `python/fuwafuwa/_core.pyi`. Signatures stay as they are; `mypy.stubtest`
compares them. The tests fail if the stub is out of date.
"""

from __future__ import annotations

import ast
import inspect
import textwrap
from pathlib import Path
from types import ModuleType

STUB = Path(__file__).parents[1] / "python" / "fuwafuwa" / "_core.pyi"


def literal(text: str, indent: str) -> str:
    """Return the lines of a docstring as source text."""
    text = text.replace("\\", "\\\\").replace('"""', '\\"\\"\\"')
    lines = textwrap.indent(text, indent)
    end = '"""' if "\n" not in text else f'\n{indent}"""'
    return f'{indent}"""{lines.lstrip()}{end}\n'


def with_docstrings(stub: str, module: ModuleType) -> str:
    """Return the text of a stub with the docstrings of a module."""
    lines = stub.splitlines(keepends=True)
    # Later bodies come first, so that the numbers of earlier lines stay valid.
    changes: list[tuple[ast.stmt, str]] = []

    def visit(body: list[ast.stmt], owner: object) -> None:
        for node in body:
            if isinstance(node, ast.ClassDef):
                found = getattr(owner, node.name)
                changes.append((node, inspect.cleandoc(found.__doc__)))
                visit(node.body, found)
            elif isinstance(node, ast.FunctionDef):
                is_setter = any(isinstance(one, ast.Attribute) for one in node.decorator_list)
                text = getattr(owner, node.name).__doc__
                # Special methods inherit the docstrings of Python.
                if text and not is_setter and not node.name.startswith("__"):
                    changes.append((node, inspect.cleandoc(text)))

    visit(ast.parse(stub).body, module)
    for node, text in reversed(changes):
        assert isinstance(node, (ast.ClassDef, ast.FunctionDef))
        first = node.body[0]
        indent = " " * (node.col_offset + 4)
        new = literal(text, indent)
        if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant):
            # The body is `...`, or begins with an older docstring.
            head = lines[first.lineno - 1].encode()[: first.col_offset].decode().rstrip()
            lines[first.lineno - 1 : first.end_lineno] = [f"{head}\n{new}" if head else new]
        else:
            decorators = first.decorator_list if isinstance(first, ast.FunctionDef) else []
            start = min([first.lineno, *(decorator.lineno for decorator in decorators)]) - 1
            lines[start:start] = [new + "\n"]
    return "".join(lines)


def main() -> None:
    """Rewrite the stub."""
    from fuwafuwa import _core

    stub = STUB.read_text(encoding="utf-8")
    STUB.write_text(with_docstrings(stub, _core), encoding="utf-8")


if __name__ == "__main__":
    main()
