#!/usr/bin/env python3
"""core_tree.py: holds the sources against the tree of core/README.md. Run from the root; prints what breaks it.

- A folder of core/ includes only the public headers and the folders below it.
- Public headers include only public headers and the standard library, and define no macro.
- proto/, server/ and client/ include only the core's public headers.
- Processor instructions are named in core/simd alone.
- No two sources of a library have a private constant or type of one name: several are compiled as one.
- No file of core/ is longer than 400 lines, and each folder has a README.md.
"""

import pathlib
import re
import sys

BELOW = {"simd": [], "base": ["simd"]}
BELOW["mesh"] = ["base", "simd"]
BELOW["rules"] = [*BELOW["mesh"], "mesh"]
BELOW["split"] = [*BELOW["mesh"], "mesh"]
BELOW["criteria"] = [*BELOW["rules"], "rules"]
BELOW["hierarchy"] = [*BELOW["criteria"], "split", "criteria"]
BELOW["simplify"] = [*BELOW["mesh"], "mesh", "criteria"]
BELOW["detail"] = [*BELOW["mesh"], "mesh", "rules", "split"]
BELOW["schemes"] = [*BELOW["hierarchy"], "hierarchy", "simplify"]
MOST_LINES = 400

found = []


def includes(text):
    return re.findall(r'^\s*#\s*include\s*["<]([^">]+)[">]', text, re.MULTILINE)


def sources(folder):
    return sorted(path for path in pathlib.Path(folder).rglob("*") if path.suffix in (".h", ".cpp"))


def check_core(path):
    text = path.read_text()
    folder = path.parts[1]
    if folder not in ("include", *BELOW):
        found.append(f"{path}: no folder of core/ has this name")
        return
    if len(text.splitlines()) > MOST_LINES:
        found.append(f"{path}: longer than {MOST_LINES} lines")
    if folder != "simd" and re.search(r"immintrin|\b_mm\d*_", text):
        found.append(f"{path}: only core/simd names processor instructions")
    for name in includes(text):
        of = name.split("/")[0]
        is_standard = "/" not in name and not name.endswith(".h")
        if folder == "include":
            if of != "papilio" and not is_standard:
                found.append(f"{path}: a public header includes {name}")
        elif of in BELOW and of != folder and of not in BELOW[folder]:
            found.append(f"{path}: {folder}/ does not include {of}/ ({name})")
        elif of in ("core", "proto", "server", "client", "tests"):
            found.append(f"{path}: core/ does not include {name}")
    if folder == "include" and re.search(r"^\s*#\s*define\b", text, re.MULTILINE):
        found.append(f"{path}: a public header defines a macro")


def check_user(path):
    for name in includes(path.read_text()):
        if name.split("/")[0] in ("core", *BELOW):
            found.append(f"{path}: only the core includes its private header {name}")


def private_names(text):
    """The constants and types that a source declares for itself, at the start of a line."""
    for line in re.findall(r"^constexpr [^;]*;", text, re.MULTILINE):
        yield from re.findall(r"(\w+)(?=(?:\[\w*\])* = )", line)
    yield from re.findall(r"^(?:class|struct|enum class) (\w+) (?:final )?[:{]", text, re.MULTILINE)


def check_private_names(library):
    known = {}
    for path in sources(library):
        if path.suffix != ".cpp" or {"node_modules", "wasm", "c"} & set(path.parts):
            continue
        for name in set(private_names(path.read_text())):
            if name in known:
                found.append(f"{path}: {name} is a private name of {known[name]}, too")
            known[name] = path


def main():
    for path in sources("core"):
        check_core(path)
    for folder in ("proto", "server", "client"):
        for path in sources(folder):
            if "node_modules" not in path.parts:
                check_user(path)
    for library in ("core", "proto", "server", "client"):
        check_private_names(library)
    for folder in (*BELOW, "include"):
        if not pathlib.Path("core", folder, "README.md").exists():
            found.append(f"core/{folder}: has no README.md")
    for line in found:
        print(line)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
