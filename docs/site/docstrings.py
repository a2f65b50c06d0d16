"""Docstrings of the API; an extension of griffe, which reads stubs and sources.

The docstrings of the compiled module come from the module itself. Roles of Sphinx become links.
"""

from __future__ import annotations

import inspect
import re
from operator import attrgetter
from typing import Any

import griffe
import vibrissa

COMPILED = "vibrissa._core."
ROLE = re.compile(r":(?:class|func|meth|mod|attr):`([\w.]+)`")
# A term and its definition, indented, and a parameter and its type, which is code already.
DEFINITION = re.compile(r"^(\w.*)\n    (?=\S)", re.MULTILINE)
TYPE = re.compile(r"^\w+ : .*`.*$", re.MULTILINE)


class Docstrings(griffe.Extension):
    def on_package(self, *, pkg: griffe.Module, **_: Any) -> None:
        self.on_object(obj=pkg)

    def on_object(self, *, obj: griffe.Object, **_: Any) -> None:
        name = obj.path.removeprefix(COMPILED)
        if name != obj.path and not re.search(r"\b_", name):
            text = inspect.getdoc(attrgetter(name)(vibrissa._core))
            obj.docstring = griffe.Docstring(text, parent=obj, parser="numpy") if text else None
            # Compiled classes have no __init__, which is where arguments are looked for.
            if "__new__" in obj.members:
                obj.members["__init__"] = obj.members.pop("__new__")
        if obj.docstring:
            text = ROLE.sub(lambda role: _link(role[1], obj), obj.docstring.value.replace("``", "`"))
            text = TYPE.sub(lambda line: line[0].replace("`", ""), text)
            obj.docstring.value = DEFINITION.sub(r"\n**\1**: ", text) if obj.is_module else text


def _link(name: str, obj: griffe.Object) -> str:
    """The name, as seen from the object, as a link if it is one of this package."""
    module = re.sub(r"\._\w+$", "", obj.module.path)
    owner = obj if obj.is_class else obj.parent
    if name.startswith("vibrissa."):
        there = name
    elif owner and owner.is_class and name in owner.members:
        there = f"{module}.{owner.name}.{name}"
    elif name.split(".")[0] in obj.module.members:
        there = f"{module}.{name}"
    else:
        return f"`{name}`"
    return f"[`{name.removeprefix('vibrissa.')}`][{there}]"
