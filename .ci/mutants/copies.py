"""Copies the repository with many mutants in it, builds its tests, and runs programs for a limited time."""

import collections
import json
import os
import shlex
import shutil
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
# Text before and after the original, by the form of a change.
FORMS = {
    "value": ("(if crate::mutant::is({}) {{ {} }} else {{ (", ") })"),
    "statement": ("if crate::mutant::is({}) {{ {} }} else {{ ", " }"),
    "return": ("if crate::mutant::is({}) {{ {} }} ", ""),
}
CARGO = {"CARGO_INCREMENTAL": "0"}
DAY = 86400
# Longest time without output, beyond the limit of processor time, in seconds.
WAITING = 1800


def crate_root(repository, path):
    """Returns the lib.rs of the crate of a file or folder."""
    candidates = (folder / "lib.rs" for folder in Path(path, "lib.rs").parents)
    return next(file for file in candidates if (repository / file).exists())


def list_sites(repository, roots):
    """Returns all mutants of crates, of which each is given by its lib.rs."""
    lister = ["cargo", "run", "--quiet", "--manifest-path", HERE / "Cargo.toml", "--"]
    sites = []
    for root in sorted(roots):
        output = subprocess.run([*lister, root], cwd=repository, check=True, stdout=subprocess.PIPE, text=True).stdout
        sites += map(json.loads, output.splitlines())
    return sites


def splice(text, sites):
    """Puts mutants into a source, as bytes. Sets the bounds of each in the result."""
    edits = []
    for site in sites:
        before, after = FORMS[site["form"]]
        before = before.format(site["number"], site["text"])
        # Of mutants that begin or end together the longer one is outside.
        edits.append((site["start"], 1, -site["end"], site["number"], before, site))
        edits.append((site["end"], 0, -site["start"], -site["number"], after, site))
    result, done = b"", 0
    for position, _, _, _, added, site in sorted(edits, key=lambda edit: edit[:4]):
        result, done = result + text[done:position], position
        site.setdefault("from", len(result))
        result += added.encode()
        site["to"] = len(result)
    return result + text[done:]


def write_copy(repository, copy, sites):
    """Copies the repository with the mutants. Leaves unchanged files alone, so that cargo does not compile them again."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z"]
    listed = subprocess.run(command, cwd=repository, check=True, stdout=subprocess.PIPE, text=True).stdout
    files = {name for name in listed.split("\0") if (repository / name).is_file()}
    roots = {str(crate_root(repository, site["file"])) for site in sites}
    in_file = collections.defaultdict(list)
    for site in sites:
        site.pop("from", None)
        in_file[site["file"]].append(site)
    for name in files:
        text = splice((repository / name).read_bytes(), in_file[name])
        if name in roots:
            text += (HERE / "mutant.rs").read_bytes()
        path = copy / name
        if not path.exists() or path.read_bytes() != text:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(text)
            shutil.copymode(repository / name, path)
    for path in copy.rglob("*"):
        if path.is_file() and str(path.relative_to(copy)) not in files:
            path.unlink()


def processor_time(process):
    """Returns the seconds of processor time of a process and of its children that have ended."""
    fields = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")


def watch(command, folder, environment, limit, fails):
    """Runs a program until it ends, or `fails` returns a reason for a line of its output, or no line comes.

    The limit is in seconds of processor time after a line, so that a busy machine does not look like a program that hangs. A
    program that waits for something ends by the clock. Returns the reason of the failure, or None, and the time by the clock."""
    start, ended, is_late, reason, line = time.monotonic(), threading.Event(), threading.Event(), None, ""
    process = subprocess.Popen(
        command,
        cwd=folder,
        env=os.environ | environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        errors="replace",
        start_new_session=True,
    )
    lines = [(start, 0.0)]

    def guard():
        while not ended.wait(1.0):
            since, spent = lines[-1]
            if processor_time(process) - spent > limit or time.monotonic() - since > limit + WAITING:
                is_late.set()
                os.killpg(process.pid, signal.SIGKILL)
                return

    watchdog = threading.Thread(target=guard)
    watchdog.start()
    for line in process.stdout:
        if reason := fails(line):
            os.killpg(process.pid, signal.SIGKILL)
            break
        lines.append((time.monotonic(), processor_time(process)))
    # The process keeps its number until it is waited for.
    os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
    ended.set()
    watchdog.join()
    code = process.wait()
    if code and not reason:
        reason = f"time limit, {line.strip()}" if is_late.is_set() else f"exit code {code}"
    return reason, time.monotonic() - start


def build(copy, target, tests, environment, limit):
    """Builds tests. Returns the executables, the compiler's messages, the reason of a failure and the time."""
    lines = []
    command = ["cargo", "test", "--no-run", "--message-format=json", *shlex.split(tests)]
    environment = CARGO | {"CARGO_TARGET_DIR": str(target)} | environment
    reason, seconds = watch(command, copy, environment, limit, lines.append)
    executables, messages = [], []
    for line in map(json.loads, lines):
        if line["reason"] == "compiler-message":
            messages.append(line["message"])
        elif line.get("executable") and line["profile"]["test"]:
            folder, aim = Path(line["manifest_path"]).parent, line["target"]
            # The identity of a package has its name only if its folder is named otherwise.
            name, has_name, _ = line["package_id"].partition("#")[2].partition("@")
            executables.append({
                "name": f"{folder.relative_to(copy)}: {aim['name']} ({aim['kind'][0]})",
                "executable": line["executable"],
                "folder": str(folder),
                "package": name if has_name else folder.name,
                "source": aim["src_path"],
            })
    return executables, messages, reason, seconds


def blamed(message, sites):
    """Returns the number of the mutant at the place of a message, or of the nearest one in the file."""
    for span in sorted(message["spans"], key=lambda span: not span["is_primary"]):
        in_file = [site for site in sites if site["file"] == span["file_name"]]
        if in_file:
            off = lambda site: max(site["from"] - span["byte_start"], span["byte_end"] - site["to"], 0)
            return min(in_file, key=lambda site: (off(site), site["to"] - site["from"]))["number"]
    return None


def build_with_mutants(options, sites):
    """Builds the tests with those mutants that compile. Returns the executables and the mutants."""
    while True:
        write_copy(options.repository, options.work / "copy", sites)
        target = options.work / "target"
        executables, messages, reason, seconds = build(options.work / "copy", target, options.tests, {}, DAY)
        if not reason:
            # The function `is` is deprecated.
            uses = [message for message in messages if (message["code"] or {}).get("code") == "deprecated"]
            used = {blamed(message, sites) for message in uses} - {None}
            print(f"built in {seconds:.0f} s; {len(sites) - len(used)} mutants are in code for other features", flush=True)
            return executables, [site for site in sites if site["number"] in used]
        errors = [message for message in messages if message["level"] == "error"]
        wrong = {blamed(message, sites) for message in errors} - {None}
        print(f"{len(wrong)} mutants do not compile ({seconds:.0f} s)", flush=True)
        if not wrong:
            sys.exit("\n".join(["the copy does not build", *(message["rendered"] for message in errors)]))
        sites = [site for site in sites if site["number"] not in wrong]
