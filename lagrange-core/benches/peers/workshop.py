"""Where things are built, and with what."""

import json
import os
import platform
import re
import subprocess
import sys
import venv
from dataclasses import dataclass
from datetime import date
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[2]
SHOP = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")).resolve() / "peers"
PYTHON = SHOP / "venv" / "bin" / "python"


class Missing(Exception):
    """A peer that cannot be had here, and why."""


@dataclass(frozen=True)
class Flags:
    """What the compilers are told about the CPU; the same for everyone."""

    name: str
    gcc: tuple
    rustc: tuple

    def environment(self):
        return os.environ | {"RUSTFLAGS": " ".join(self.rustc)}


NATIVE = Flags("native", ("-O3", "-march=native"), ("-C", "target-cpu=native"))
PLAIN = Flags("plain", ("-O3",), ())
AVX2 = Flags("avx2", ("-O3", "-march=x86-64-v3"), ("-C", "target-cpu=x86-64-v3"))


def lanes(flags):
    """As many lanes as ours has with these flags."""
    return 8 if 'target_feature="avx512f"' in run("rustc", "--print", "cfg", *flags.rustc) else 4


def progress(text):
    print(text, file=sys.stderr, flush=True)


def run(*command, seconds=600, **options):
    """The standard output of a command; what it says where it fails is the reason that something is missing."""
    command = [str(part) for part in command]
    try:
        return subprocess.run(command, check=True, capture_output=True, text=True, timeout=seconds, **options).stdout
    except subprocess.TimeoutExpired:
        raise Missing(f"`{Path(command[0]).name}` takes more than {seconds} s") from None
    except FileNotFoundError:
        raise Missing(f"`{command[0]}` is not installed") from None
    except subprocess.CalledProcessError as error:
        said = (error.stderr.strip() or error.stdout.strip() or f"exit code {error.returncode}").splitlines()
        raise Missing(f"`{Path(command[0]).name}` fails: {said[-1]}") from None


def set_up_python():
    """A virtual environment with the packages that requirements.txt pins; one that cannot be had is left out."""
    wanted, stamp = (HERE / "requirements.txt").read_text(), SHOP / "venv" / "requirements.txt"
    if stamp.exists() and stamp.read_text() == wanted:
        return
    progress("packages: " + ", ".join(wanted.split()))
    venv.create(SHOP / "venv", with_pip=True, clear=True)
    failed = False
    for package in wanted.split():
        try:
            run(PYTHON, "-m", "pip", "install", "--quiet", package)
        except Missing as reason:
            failed = True
            progress(f"  missing {package}: {reason}")
    if not failed:
        stamp.write_text(wanted)


def generate(script, *arguments, seconds=600):
    """What a generator prints: what its function takes."""
    return json.loads(run(PYTHON, HERE / "generators" / script, *arguments, seconds=seconds))


def build_ours(package, flags, *features):
    """The folder with the release build of a crate here, as `cargo build --release` makes it."""
    target = SHOP / "-".join([package, flags.name, *features])
    environment = flags.environment() | {"CARGO_TARGET_DIR": str(target)}
    run("cargo", "build", "--release", "--features", ",".join(features), cwd=HERE / package, env=environment)
    return target / "release"


def about():
    """What is compared, where, when and with what."""
    cpu = re.search(r"model name\s*: (.*)", Path("/proc/cpuinfo").read_text())
    lock = (HERE / "dual-numbers" / "Cargo.lock").read_text()
    return {
        "date": str(date.today()),
        "commit": run("git", "describe", "--always", "--dirty", cwd=ROOT).strip(),
        "cpu": cpu[1] if cpu else platform.processor(),
        "cores": os.cpu_count(),
        "system": platform.system(),
        "load": os.getloadavg()[0],
        "rustc": run("rustc", "--version", cwd=HERE).strip(),
        "gcc": run("gcc", "--version").splitlines()[0],
        "python": platform.python_version(),
        "packages": dict(line.split("==") for line in (HERE / "requirements.txt").read_text().split()),
        "num-dual": re.search(r'name = "num-dual"\nversion = "(.*)"', lock)[1],
    }
