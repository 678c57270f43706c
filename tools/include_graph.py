"""The rooms of the repository and the arrows between them: what docs/architecture.md allows, and what the sources include.

The table on that page is the only list of rooms there is. This module reads it and compares; tests/structure fails on what differs,
tools/rooms.py draws it.
"""

import re
import subprocess
from collections import defaultdict
from pathlib import PurePosixPath

PAGE = "docs/architecture.md"
HEADING = "## Rooms and arrows"
OUTSIDE = ("tests", "docs")  # tests may include any room
SOURCES = (".cpp", ".hpp", ".c", ".h", ".in", ".S")
INCLUDE = re.compile(r'^\s*#\s*include\s+(["<])([^">]+)[">]', re.M)
SYSTEM_HEADER = re.compile(r"(experimental/)?[a-z0-9_]+|(sys|gnu)/[a-z0-9_-]+\.h")  # <vector>, <sys/stat.h>
SYSTEM_FILES = set("dlfcn elf fcntl fnmatch grp iconv link malloc poll pwd sched spawn termios unistd".split())  # <unistd.h>
TICKED = re.compile(r"`([^`]+)`")


class Room:
    """A row of the table."""

    def __init__(self, line, cells):
        self.line, self.folder, self.holds = line, TICKED.search(cells[0]).group(1).rstrip("/"), cells[1].strip()
        self.uses, self.libraries = (TICKED.findall(cell) for cell in cells[2:4])


def files_of(root):
    """What git tracks or would; in a tree without git, everything but builds."""
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=root, capture_output=True) if (root / ".git").exists() else None
    if listed is not None and listed.returncode == 0:
        paths = [root / p for p in listed.stdout.decode().split("\0") if p]
    else:
        paths = [p for p in root.rglob("*") if p.relative_to(root).parts[0] not in ("build", ".git")]
    return sorted(p for p in paths if p.is_file())


def rows_of(text):
    """(line number, cells) of each row of the first table behind the heading."""
    inside, rows = False, []
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("## "):
            inside = line.strip() == HEADING
        elif inside and line.startswith("|"):
            rows.append((number, [cell.strip() for cell in line.strip().strip("|").split("|")]))
        elif rows:
            break
    return rows[2:]  # without the heads and the rule below them


class Table:
    """The page's table: folder → Room, and what is wrong with the table itself."""

    def __init__(self, root):
        page = root / PAGE
        rows = rows_of(page.read_text(encoding="utf-8")) if page.exists() else []
        self.rooms, self.faults = {}, []
        if not rows:
            self.faults.append("%s: no table behind '%s'; each room needs its row there" % (PAGE, HEADING))
        for number, cells in rows:
            if len(cells) != 4 or not TICKED.fullmatch(cells[0]):
                self.faults.append("%s:%d: a row is | `folder/` | holds | may use | libraries |" % (PAGE, number))
                continue
            room = Room(number, cells)
            if room.folder in self.rooms:
                self.faults.append("%s:%d: %s has a row above already" % (PAGE, number, room.folder))
            self.rooms[room.folder] = room
        for room in self.rooms.values():
            room.uses = [used for used in (self.named(room, name) for name in room.uses) if used]

    def named(self, room, name):
        """The folder that a row means by a name: the folder itself or the last word of it. It stands in a row above."""
        found = [folder for folder in self.rooms if name in (folder, folder.split("/")[-1])]
        where = "%s:%d: %s" % (PAGE, room.line, room.folder)
        if len(found) != 1:
            self.faults.append("%s may use %s, which is %s" % (where, name, "no room of the table" if not found else " or ".join(found)))
            return None
        if self.rooms[found[0]].line >= room.line:
            self.faults.append("%s may use %s, whose row does not stand above its own" % (where, name))
        return found[0]

    def short(self, folder):
        """The last word of a folder, where no other room has it."""
        word = folder.split("/")[-1]
        return word if sum(other.split("/")[-1] == word for other in self.rooms) == 1 else folder

    def room_of(self, path):
        """The room that a path lies in: of two that hold it, the inner one."""
        parents = [parent.as_posix() for parent in PurePosixPath(path).parents]
        return next((parent for parent in parents if parent in self.rooms), None)

    def holds_rooms(self, folder):
        return any(other.startswith(folder + "/") for other in self.rooms)


class Arrow:
    """One include that leaves its room: of another room, of a library, or (to is None) of nothing that is there."""

    def __init__(self, path, line, header, origin, to, library):
        self.path, self.line, self.header, self.origin, self.to, self.library = path, line, header, origin, to, library


def is_standard(header):
    return SYSTEM_HEADER.fullmatch(header) is not None or header.removesuffix(".h") in SYSTEM_FILES


def target_of(root, table, path, header):
    """The room that a header lies in, or None. It is named from the root, from the SDK, or beside the file that includes it."""
    beside = PurePosixPath(path).parent / header
    parts = []
    for part in beside.parts:
        parts = parts[:-1] if part == ".." else parts + [part]
    beside = "/".join(parts)
    if header.startswith(".") or (root / beside).exists():
        return table.room_of(beside)
    return "sdk" if header.startswith("millscope/") else table.room_of(header)


def arrows_of(root, table, path, text):
    origin = table.room_of(path)
    for found in INCLUDE.finditer(text):
        mark, header = found.groups()
        to = target_of(root, table, path, header)
        if to == origin or (to is None and mark == "<" and is_standard(header)):
            continue
        yield Arrow(path, text.count("\n", 0, found.start(1)) + 1, header, origin, to, to is None and mark == "<")


def sources_of(root):
    """(path, text) of each source that must lie in a room."""
    for file in files_of(root):
        path = file.relative_to(root).as_posix()
        if file.suffix in SOURCES and path.split("/")[0] not in OUTSIDE:
            yield path, file.read_text(encoding="utf-8", errors="replace")


def folders_without_row(root, table):
    """Folders that are rooms by what they hold and have no row: sources in none, or beside rooms; or a CMakeLists.txt of their own."""
    found = {}
    for file in files_of(root):
        path = file.relative_to(root)
        if path.parts[0] in OUTSIDE or len(path.parts) == 1 or not (file.suffix in SOURCES or file.name == "CMakeLists.txt"):
            continue
        folder, room = path.parent.as_posix(), table.room_of(path.as_posix())
        if file.name == "CMakeLists.txt":
            missing = folder if folder not in table.rooms and not table.holds_rooms(folder) else None
        elif room is None:
            missing = folder
        else:
            inner = path.relative_to(room).parts[:-1]
            missing = "%s/%s" % (room, inner[0]) if inner and table.holds_rooms(room) else None
        if missing:
            found.setdefault(missing, path.as_posix())
    return found


def find_cycle(graph):
    """The rooms of one cycle, from the first of the alphabet back to it; [] where there is none. `graph`: room → rooms it uses."""
    done, trail = set(), []

    def visit(room):
        if room in trail:
            cycle = trail[trail.index(room):]
            first = cycle.index(min(cycle))
            return cycle[first:] + cycle[:first + 1]
        if room in done:
            return []
        trail.append(room)
        for used in sorted(graph.get(room, ())):
            cycle = visit(used)
            if cycle:
                return cycle
        trail.pop()
        done.add(room)
        return []

    return next((cycle for cycle in (visit(room) for room in sorted(graph)) if cycle), [])


def graph_of(root, table):
    """What the sources say: room → room it uses → arrows."""
    graph = {room: defaultdict(list) for room in table.rooms}
    for path, text in sources_of(root):
        for arrow in arrows_of(root, table, path, text):
            if arrow.origin and arrow.to:
                graph[arrow.origin][arrow.to].append(arrow)
    return graph


def libraries_of(root, table):
    """What the sources say of libraries: room → names, those of its row as they stand there."""
    found = {room: set() for room in table.rooms}
    for path, text in sources_of(root):
        for arrow in arrows_of(root, table, path, text):
            if arrow.origin and arrow.library:
                listed = next((name for name in table.rooms[arrow.origin].libraries if arrow.header.startswith(name)), None)
                found[arrow.origin].add(listed or re.match(r"[\w-]+", arrow.header).group(0))
    return {room: sorted(names, key=str.lower) for room, names in found.items()}


def faults_of(root):
    """What differs between page and sources, a line each."""
    table = Table(root)
    yield from table.faults
    for folder, path in sorted(folders_without_row(root, table).items()):
        yield "%s: is a room (%s) without a row in %s" % (folder, path, PAGE)
    used, filled = defaultdict(set), set()
    for path, text in sources_of(root):
        if not table.room_of(path):
            continue
        filled.add(table.room_of(path))
        for arrow in arrows_of(root, table, path, text):
            row = table.rooms[arrow.origin]
            match = next((name for name in row.libraries if arrow.header.startswith(name)), None) if arrow.library else arrow.to
            if match in row.libraries + row.uses:
                used[arrow.origin].add(match)
            else:
                allowed = ", ".join(row.uses + row.libraries) or "the standard library"
                yield "%s:%d: %s may not include %s; it may use %s" % (path, arrow.line, arrow.origin, arrow.header, allowed)
    for row in table.rooms.values():
        where = "%s:%d: the row of %s" % (PAGE, row.line, row.folder)
        if row.folder not in filled:
            yield "%s matches no source; take the row out" % where
            continue
        for name in row.uses + row.libraries:
            if name not in used[row.folder]:
                yield "%s allows %s, which nothing there includes; take it out" % (where, name)
