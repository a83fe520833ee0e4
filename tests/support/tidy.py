#!/usr/bin/env python3
"""tidy.py CLANG_TIDY FILE...: clang-tidy on sources, with the compile commands of build/check.

Most of its time goes into system headers, so the sources of a folder that are compiled alike are read together, as one
source that includes them. What passed is not read again, in whichever checkout, until one of the sources, a header of the
project that they include, the rules or the compile command change. Run from the root; prints what is found, and fails if
anything is.
"""

import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys

MOST_TOGETHER = 16
BUILD = "build/check"
OF_GCC_ALONE = " -fno-ipa-modref"  # an error to clang
ROOT = os.getcwd()


def compile_commands():
    """The command of each source, by its path from the root, less what names the source and its object."""
    commands = {}
    for entry in json.loads(pathlib.Path(BUILD, "compile_commands.json").read_text()):
        path = os.path.relpath(entry["file"], ROOT)
        command = re.sub(r" -o \S+ -c \S+$", "", entry["command"]).replace(OF_GCC_ALONE, "")
        commands.setdefault(path, command)
    return commands


def groups_of(files, commands):
    """Lists of sources to be read together, each with its command."""
    alike = {}
    for path in files:
        alike.setdefault((os.path.dirname(path), commands[path]), []).append(path)
    for (_, command), paths in alike.items():
        for first in range(0, len(paths), MOST_TOGETHER):
            yield paths[first : first + MOST_TOGETHER], command


def digest_of(*texts):
    digest = hashlib.sha256()
    for text in texts:
        digest.update(text if isinstance(text, bytes) else text.encode())
        digest.update(b"\0")
    return digest.hexdigest()


class Headers:
    """The project's headers, by each name that an include may give them: the end of their path."""

    def __init__(self):
        self.named = {}
        self.included = {}  # by a source or header: the headers that it includes itself
        listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard", "core", "proto", "server", "client"],
                                capture_output=True, check=True, text=True).stdout.split()
        for path in listed:
            if not path.endswith(".h") or not os.path.exists(path):
                continue
            parts = path.split("/")
            for first in range(len(parts)):
                self.named.setdefault("/".join(parts[first:]), []).append(path)

    def included_by(self, path):
        if path not in self.included:
            names = re.findall(r'^#include "([^"]+)"', pathlib.Path(path).read_text(), re.MULTILINE)
            self.included[path] = [header for name in names for header in self.named.get(name, [])]
        return self.included[path]

    def behind(self, sources):
        """The headers that sources include, and those that these do, in the order of their paths."""
        found, left = set(), list(sources)
        while left:
            for header in self.included_by(left.pop()):
                if header not in found:
                    found.add(header)
                    left.append(header)
        return sorted(found)


class Reader:
    def __init__(self, program):
        self.program = program
        self.headers = Headers()
        version = subprocess.run([program, "--version"], capture_output=True, check=True).stdout
        self.rules = digest_of(version, pathlib.Path(".clang-tidy").read_bytes(), pathlib.Path(__file__).read_bytes())
        cache = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
        self.cache = pathlib.Path(cache, "papilio", "clang-tidy")
        self.cache.mkdir(parents=True, exist_ok=True)

    def read(self, group):
        """What is found in the sources of a group; nothing if it is sound."""
        paths, of_all = group
        read = [*paths, *self.headers.behind(paths)]
        texts = [pathlib.Path(path).read_bytes() for path in read]
        passed = self.cache / digest_of(self.rules, of_all.replace(ROOT, ""), *read, *texts)
        if passed.exists():
            return ""
        folder = pathlib.Path(ROOT, "build", "tidy", digest_of(*paths)[:16])
        folder.mkdir(parents=True, exist_ok=True)
        together = folder / "together.cpp"
        together.write_text("".join(f'#include "{ROOT}/{path}"  // NOLINT(bugprone-suspicious-include)\n' for path in paths))
        command = f"{of_all} -o together.o -c {together}"
        entry = {"directory": os.path.join(ROOT, BUILD), "command": command, "file": str(together)}
        (folder / "compile_commands.json").write_text(json.dumps([entry]))
        made = subprocess.run(
            [self.program, "--quiet", "-p", str(folder), f"--config-file={ROOT}/.clang-tidy",
             "--extra-arg=-Wno-unknown-warning-option", str(together)],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        if made.returncode == 0:
            passed.touch()
            return ""
        if "[clang-diagnostic-error]" in made.stdout and len(paths) > 1:  # two use one name for themselves
            half = len(paths) // 2
            return "\n".join(filter(None, (self.read((part, of_all)) for part in (paths[:half], paths[half:]))))
        counts = re.compile(r"^\d+ warnings? (generated|treated)")  # of what system headers hide
        return "\n".join(line for line in made.stdout.splitlines() if not counts.match(line))


def main(program, *files):
    commands = compile_commands()
    missing = [path for path in files if path not in commands]
    for path in missing:
        print(f"{path}: no target of the build compiles it")
    reader = Reader(program)
    groups = groups_of([path for path in files if path in commands], commands)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        found = [text for text in pool.map(reader.read, groups) if text]
    print("\n".join(found))
    return 1 if missing or found else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
