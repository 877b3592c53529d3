"""Faults of what is asked of other operating systems: the wrong file, or another name."""

from __future__ import annotations

from faults.mutation import Mutation

TESTS = "tests/test_systems.py"
PLACES = "gcxform/system/places.py"

MUTATIONS = (
    Mutation(
        "UTF-16: the zeros of a paper tape count",
        "gcxform/system/inputs.py",
        "zeros = (all(low) and not any(high)) or (all(high) and not any(low))",
        "zeros = not any(high) or not any(low)",
        "tests/test_systems.py::test_utf16_without_its_mark_is_named",
    ),
    Mutation(
        "systems: a result goes to a device",
        PLACES,
        '    if _DEVICES.fullmatch(name.partition(".")[0]):\n',
        "    if _DEVICES.fullmatch(name):\n",
        TESTS,
    ),
    Mutation(
        "systems: a result goes behind another file",
        PLACES,
        "    if found := _NO_NAME.search(name):\n",
        "    if found := None:\n",
        TESTS,
    ),
    Mutation(
        "systems: a folder is another one when it is spelt otherwise",
        PLACES,
        "    return bool(wanted.st_ino) and os.path.samestat(found, wanted)",
        "    return False and os.path.samestat(found, wanted)",
        TESTS,
    ),
    Mutation(
        "systems: a program is replaced by a result whose name is spelt otherwise",
        PLACES,
        '    return not {name, again} <= {*os.listdir(folder or ".")}',
        "    return False",
        TESTS,
    ),
    Mutation(
        "systems: a post that is a class is a base",
        "gcxform/cli/host/freecad_post.py",
        '                if hasattr(module, "export"):\n',
        "                if True:\n",
        "tests/test_freecad_later.py",
    ),
    Mutation(
        "systems: what has one name only is moved over another file",
        "gcxform/cli/watching/folders.py",
        "    except OSError:\n        if os.path.lexists(target):",
        "    except OSError:\n        if not os.path.lexists(source):",
        TESTS,
    ),
    Mutation(
        "systems: UTF-16 is read as letters",
        "gcxform/syntax/source.py",
        "            if is_utf16(copy.read(64)):\n",
        "            if copy.read(2) in ():\n",
        TESTS,
    ),
)
