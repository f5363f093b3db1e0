#!/usr/bin/env python3
"""Prints measures of the structure of this source tree, as a table in Markdown.

    tools/scripts/structure.py                    measures that are read from the sources
    tools/scripts/structure.py --build            also the size of the binary, and a cold release build and test build
    tools/scripts/structure.py --cycles           also the files of every import cycle

The sources are read as text. An import is a path that begins with `crate`, `self` or `super`, in a `use` or in an expression. A name
that a `mod.rs` or `lib.rs` re-exports counts as an import of the file that defines the name. Tests and comments do not count.
"""

import argparse
import os
import re
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CRITERION_ROW = re.compile(r'^\s*\w+ = "([a-z-]+)"', re.M)
CRITERIA = re.compile('"(%s)"' % "|".join(CRITERION_ROW.findall((ROOT / "validators/src/criterion.rs").read_text())))
COMMENT_OR_STRING = re.compile(r'//[^\n]*|/\*.*?\*/|r(#*)".*?"\1|b?"(?:[^"\\]|\\.)*"|\'(?:[^\'\\]|\\.)\'', re.S)


def tracked():
    """Returns the files of the checkout that are under version control."""
    out = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return [Path(name) for name in out.split("\0") if name]


def crates(files):
    """Returns the folders of the packages in the workspace, by name."""
    return sorted({path.parent for path in files if path.name == "Cargo.toml" and path.parent != Path(".")
                   and (ROOT / path.parent / "src").is_dir()})


def split_tests(text):
    """Returns the text before the first `#[cfg(test)]` module at the left margin, and the remaining text."""
    at = re.search(r"^#\[cfg\(test\)\]\n(?:pub(?:\([^)]*\))? )?mod \w+ \{", text, re.M)
    return (text[:at.start()], text[at.start():]) if at else (text, "")


def without_comments(text, keep_strings):
    return COMMENT_OR_STRING.sub(lambda found: found[0] if keep_strings and not found[0].startswith("/") else " ", text)


class Modules:
    """The files of one crate, by their module paths."""

    def __init__(self, crate, files):
        self.source = crate / "src"
        self.paths, self.code = {}, {}
        for file in files:
            if file.suffix != ".rs" or self.source not in file.parents:
                continue
            path = file.relative_to(self.source).with_suffix("").parts
            if path[-1] in ("mod", "lib", "main"):
                path = path[:-1]
            self.paths[path] = file
            self.code[path] = without_comments(split_tests((ROOT / file).read_text())[0], keep_strings=False)
        self.exports = {path: self.re_exports(path) for path in self.paths}

    def re_exports(self, path):
        """Returns the path behind each name that a module re-exports."""
        names = {}
        for use in re.findall(r"\bpub(?:\([^)]*\))?\s+use\s+([^;]+);", self.code[path]):
            for target in expand(use):
                names[target[1]] = target[0]
        return names

    def file_of(self, module, path, depth=0):
        """Returns the module that contains the item to which `path`, written in `module`, refers. Returns None if the
        path leaves the crate.
        """
        if depth > 8 or not path:
            return None
        base = list(module)
        if path[0] == "crate":
            base, path = [], path[1:]
        elif path[0] == "self":
            path = path[1:]
        elif path[0] == "super":
            while path and path[0] == "super":
                base, path = base[:-1], path[1:]
        elif tuple(base + [path[0]]) not in self.paths:
            return None
        while path and tuple(base + [path[0]]) in self.paths:
            base, path = base + [path[0]], path[1:]
        at = tuple(base)
        if path and path[0] in self.exports.get(at, {}):
            further = self.file_of(at, list(self.exports[at][path[0]]), depth + 1)
            return further if further is not None else at
        return at

    def arrows(self):
        """Returns the imports of each module, except for imports of the module itself."""
        arrows = {path: set() for path in self.paths}
        for path, code in self.code.items():
            targets = [target for use in re.findall(r"\buse\s+([^;]+);", code) for target, _ in expand(use)]
            targets += [found.split("::") for found in re.findall(r"\b(?:crate|super|self)(?:::\w+)+", code)]
            if path in self.exports:
                own = {tuple(target) for target in self.exports[path].values()}
                targets = [target for target in targets if tuple(target) not in own]
            for target in targets:
                found = self.file_of(path, list(target))
                if found is not None and found != path and found in self.paths:
                    arrows[path].add(found)
        return arrows


def expand(use):
    """Returns the paths of a `use`, each with the name that it imports."""
    use = re.sub(r"\s+", " ", use.strip())
    brace = use.find("{")
    if brace < 0:
        path, _, name = use.partition(" as ")
        parts = [part.strip() for part in path.split("::") if part.strip()]
        return [(parts, name.strip() or (parts[-1] if parts else ""))]
    head = [part.strip() for part in use[:brace].split("::") if part.strip()]
    found, depth, start, inner = [], 0, 0, use[brace + 1:use.rfind("}")]
    for index, letter in enumerate(inner + ","):
        depth += (letter == "{") - (letter == "}")
        if letter == "," and depth == 0:
            piece = inner[start:index].strip()
            start = index + 1
            if piece == "self":
                found.append((head, head[-1] if head else ""))
            elif piece:
                found += [(head + path, name) for path, name in expand(piece)]
    return found


def cycles(arrows):
    """Returns the strongly connected components that have more than one module (Tarjan's algorithm)."""
    index, low, stack, on, found = {}, {}, [], set(), []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        on.add(node)
        for other in sorted(arrows[node]):
            if other not in index:
                visit(other)
                low[node] = min(low[node], low[other])
            elif other in on:
                low[node] = min(low[node], index[other])
        if low[node] == index[node]:
            component = []
            while True:
                other = stack.pop()
                on.discard(other)
                component.append(other)
                if other == node:
                    break
            if len(component) > 1:
                found.append(sorted(component))

    sys.setrecursionlimit(10_000)
    for node in sorted(arrows):
        if node not in index:
            visit(node)
    return sorted(found, key=len, reverse=True)


def upward(arrows):
    """Returns the number of imports from a lower floor to a higher floor. A module's floor is its greatest distance
    from the ground. Cycles are broken at the import that closes them, in the order of names. Imports from the
    `mod.rs` or `lib.rs` of a module's own folder count as upward.
    """
    floor, active, back = {}, set(), 0

    def visit(node):
        nonlocal back
        if node in floor:
            return floor[node]
        active.add(node)
        height = 0
        for other in sorted(arrows[node]):
            if other in active:
                back += 1
            else:
                height = max(height, visit(other) + 1)
        active.discard(node)
        floor[node] = height
        return height

    for node in sorted(arrows):
        visit(node)
    return back


def lines(text):
    return text.count("\n")


def cold_build(arguments):
    """Returns the wall-clock and CPU seconds of a build into an empty folder, and the size of the binary."""
    with tempfile.TemporaryDirectory() as target:
        before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        subprocess.run(["cargo", *arguments], cwd=ROOT, check=True, env={**os.environ, "CARGO_TARGET_DIR": target})
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        binary = Path(target, "release", "arcade")
        size = binary.stat().st_size if binary.exists() else None
        return time.monotonic() - start, cpu, size


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", action="store_true", help="also build, which takes a few minutes")
    parser.add_argument("--cycles", action="store_true", help="list the files of every import cycle")
    args = parser.parse_args()
    files = tracked()
    rows, all_cycles, product_total = [], [], 0
    print("| crate | product lines | lines of inline tests | lines of test files | import cycles (files) |\n|---|--:|--:|--:|---|")
    literals = 0
    snapshots_up = None
    for crate in crates(files):
        product = inline = tests = 0
        for file in files:
            if file.suffix != ".rs" or crate not in file.parents:
                continue
            text = (ROOT / file).read_text()
            if crate / "src" in file.parents and "tests" not in file.relative_to(crate).parts:
                code, rest = split_tests(text)
                product, inline = product + lines(code), inline + lines(rest)
                literals += len(CRITERIA.findall(without_comments(code, keep_strings=True)))
            else:
                tests += lines(text)
        modules = Modules(crate, files)
        arrows = modules.arrows()
        found = cycles(arrows)
        all_cycles += [(crate, cycle) for cycle in found]
        if crate.name == "snapshots":
            snapshots_up = upward(arrows)
        product_total += product
        print(f"| {crate} | {product:,} | {inline:,} | {tests:,} | {', '.join(str(len(cycle)) for cycle in found) or '-'} |")
    folders = {}
    for file in files:
        if file.suffix in (".rs", ".ts", ".tsx", ".py"):
            folders.setdefault(file.parent, []).append(file)
    crowded = sorted((len(inside), str(folder)) for folder, inside in folders.items() if len(inside) > 12)
    rows.append(("product lines", f"{product_total:,}"))
    rows.append(("entries at the root", len({path.parts[0] for path in files})))
    rows.append(("folders with more than 12 source files", len(crowded)))
    rows.append(("import cycles between files", len(all_cycles)))
    rows.append(("imports that close a cycle in `snapshots`", snapshots_up))
    rows.append(("string literals that name criteria", literals))
    rows.append(("packages in Cargo.lock", (ROOT / "Cargo.lock").read_text().count("[[package]]")))
    command_files = [file for file in files if file.suffix == ".rs" and file.parts[:2] in (("cli", "src"), ("crates", "cli"))]
    rows.append(("`#[arg]` attributes of the command line", sum((ROOT / file).read_text().count("#[arg") for file in command_files)))
    if args.build:
        wall, cpu, size = cold_build(["build", "--release", "--locked"])
        rows.append(("cold release build", f"{wall:.0f} s, {cpu:.0f} CPU-s"))
        rows.append(("size of the binary", f"{size / 1e6:.1f} MB"))
        wall, cpu, _ = cold_build(["test", "--workspace", "--locked", "--no-run"])
        rows.append(("cold build of the tests", f"{wall:.0f} s, {cpu:.0f} CPU-s"))
    print("\n| measure | value |\n|---|--:|")
    for name, value in rows:
        print(f"| {name} | {value} |")
    if args.cycles:
        for crate, cycle in all_cycles:
            print(f"\n{crate}: " + ", ".join("/".join(path) or "(root)" for path in cycle))


if __name__ == "__main__":
    main()
