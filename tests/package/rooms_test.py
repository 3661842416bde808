#!/usr/bin/env python3
"""rooms_test.py SOURCE_DIR: includes go one way between folders, and no folder is crowded.

Fails if folders include each other in a circle, if an #include names a file that is not there, or if a folder
has more files of ours at one level than docs/architecture.md allows without a reason."""
import collections
import pathlib
import re
import sys

MOST = 15
ROOTS = ("mapping", "brdf", "fitting", "tools")


def sources(root):
    for top in ROOTS:
        for path in sorted((root / top).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                yield path.relative_to(root)


def included(root, path):
    text = (root / path).read_text()
    for name in re.findall(r'^#include [<"](?:gonio/)?((?:mapping|brdf|fitting|tools)/[^>"]+)[>"]', text, re.M):
        yield pathlib.Path(name)


def circle(arrows):
    """A list of folders that include each other in a circle, or None."""
    state, trail = {}, []

    def visit(room):
        state[room] = "open"
        trail.append(room)
        for other in sorted(arrows[room]):
            if state.get(other) == "open":
                return trail[trail.index(other):] + [other]
            if other not in state:
                found = visit(other)
                if found:
                    return found
        state[room] = "done"
        trail.pop()
        return None

    for room in sorted(arrows):
        if room not in state:
            found = visit(room)
            if found:
                return found
    return None


def faults(root):
    arrows, counts = collections.defaultdict(set), collections.Counter()
    for path in sources(root):
        counts[path.parent] += 1
        for other in included(root, path):
            if not (root / other).is_file():
                yield f"{path}: found #include of {other}, expected a file that is there"
            if other.parent != path.parent:
                arrows[path.parent].add(other.parent)
                arrows.setdefault(other.parent, set())
    found = circle(arrows)
    if found:
        yield "folders include each other: " + " -> ".join(map(str, found))
    reasons = (root / "docs/architecture.md").read_text()
    for room, count in sorted(counts.items()):
        if count > MOST and f"`{room}/` has" not in reasons:
            yield f"{room}: found {count} files, expected at most {MOST} or a reason in docs/architecture.md"


def main():
    root = pathlib.Path(sys.argv[1])
    # The checks can fail: a circle is found where there is one.
    assert circle({"a": {"b"}, "b": {"c"}, "c": {"a"}}) == ["a", "b", "c", "a"]
    assert circle({"a": {"b", "c"}, "b": {"c"}, "c": set()}) is None
    found = list(faults(root))
    for fault in found:
        print(fault)
    sys.exit(1 if found else 0)


main()
