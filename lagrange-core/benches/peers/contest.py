"""Contests of processes that each do their work whenever a line asks them to, in rotation."""

import array
import json
import subprocess

from peers import Implementation
from workshop import SHOP, Missing


class Contestant:
    """A process that answers each line with the seconds it took, and at its end writes down the last states."""

    def __init__(self, name, kind, label, *command):
        self.implementation = Implementation(name, kind, None)
        self.ends = SHOP / f"ends-{name}-{label}".replace(" ", "-")
        self.times, self.answer = [], {}
        self.process = subprocess.Popen(
            [*map(str, command), str(self.ends)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def run(self):
        """One run, its time in microseconds."""
        try:
            self.process.stdin.write("\n")
            self.process.stdin.flush()
            self.answer = json.loads(self.process.stdout.readline())
            self.times.append(1e6 * self.answer["seconds"])
        except (BrokenPipeError, json.JSONDecodeError):
            said = self.process.communicate()[1].strip().splitlines() or ["it ends without a word"]
            raise Missing(f"{self.implementation.name}: {said[-1]}") from None

    def finish(self):
        """The last states, as numbers one after another."""
        self.process.communicate()
        states = array.array("d")
        states.frombytes(self.ends.read_bytes())
        return states


def in_rotation(contestants, rounds):
    for _ in range(rounds):
        for one in contestants:
            one.run()
