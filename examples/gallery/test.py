#!/usr/bin/env python3
"""Tests the page in a headless Chromium.

    test.py PAGE [--pictures FOLDER] [SYSTEM...]

Every system, or those named, runs for 10 s of its time without an error, keeps what it conserves, obeys its sliders and its
link, and can be drawn; the page obeys the keyboard, and fits a phone.
"""

import argparse
import json
import pathlib
import sys

from chromium import Browser, Failed

READY = "page.show && page.paints"
# What a motion may lose in 10 s, as a part of the largest energy or momentum in it.
LOSS = 1e-9
# What is to be seen of a slider in coordinates and velocities at the start.
SEEN = {
    "bead": {"x_0": "s[0]"},
    "polar-pendulum": {"theta_0": "s[0]", "w_0": "s[3]"},
    "double-pendulum": {"theta_1": "Math.atan2(s[0], -s[2])", "l_1": "Math.hypot(s[0], s[2])"},
    "chain": {"theta": "Math.atan2(s[25] - s[24], s[74] - s[75])"},
    "spherical-pendulum": {"v_0": "s[4]", "l": "Math.hypot(s[0], s[1], s[2])"},
    "foucault-pendulum": {"a": "s[0]", "l": "Math.hypot(s[0], s[1], s[2])"},
    "race": {"v_0": "-s[6]", "a": "s[6]/s[9]"},
    "rolling-cylinder": {"X_0": "s[0]"},
    "rolling-ball": {"v_0": "s[8]"},
    "rolling-coin": {"lean": "s[4]", "w_r": "s[11]", "w_h": "s[9]"},
    "chaplygin-sleigh": {"v_0": "s[3]", "w_0": "s[5]"},
    "bouncing-ball": {"v_0": "s[3]", "w_0": "s[5]"},
    "carriage": {"theta_0": "Math.atan2(s[0], -s[1])", "l": "Math.hypot(s[0], s[1])"},
    "turntable": {"x_0": "s[0]", "u_0": "s[3]", "v_0": "s[4]"},
    "heavy-top": {"theta_0": "Math.acos(s[2]/Math.hypot(s[0], s[1], s[2]))", "l": "Math.hypot(s[0], s[1], s[2])"},
    "flipping-body": {"s": "2*Math.hypot(s[10], s[11], s[12], s[13])"},
    "stewart-platform": {"x_0": "s[0]", "z_0": "s[2] - 0.75"},
    "cart-pole": {"x_0": "s[0]", "theta_0": "s[1]"},
    "henon-heiles": {"y_0": "s[1]"},
}


def check(holds, what):
    """Raises where it does not hold."""
    if not holds:
        raise Failed(what)


def run_for_ten_seconds(tab):
    """How much of what is conserved is lost."""
    tab.tell("play(false); for (let k = 1; k <= 100; k++) goTo(0.1*k); draw()")
    check(abs(tab.tell("page.t") - 10) < 1e-6, f"it ends before 10 s: {tab.tell('element(`message`).textContent')}")
    check(tab.tell("Array.from(page.show.state(10)).every(Number.isFinite)"), "its state is not finite")
    check(tab.tell("element('message').textContent") == "", "it has a message")
    quantities = tab.tell("page.show.quantities().map((name, k) => [name, Array.from(page.show.series(k, 0, 10))])")
    largest = lambda values: max(map(abs, values))
    energy = max(largest(values) for name, values in quantities if name.startswith("energy "))
    losses = {}
    for name, values in quantities:
        check(all(isinstance(value, (int, float)) for value in values), f"{name} is not finite")
        if name.startswith("conserved ") or (name.split()[:2] == ["energy", "E"] and tab.tell("page.card.conservesEnergy")):
            change = largest([value - values[0] for value in values])
            # A momentum may be zero all the time: it is then as small as the energy's error lets it be.
            losses[name] = change / max(largest(values), energy)
    for name, loss in losses.items():
        check(loss < LOSS, f"{name} changes by {loss:.1e} of itself")
    return max(losses.values(), default=None)


def is_drawn(tab):
    """Something is seen, and it changes."""
    count = """(() => {
        const { width, height } = element("scene");
        const copy = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
        copy.drawImage(element("scene"), 0, 0);
        const { data } = copy.getImageData(0, 0, width, height);
        let sum = 0, seen = 0;
        for (let k = 3; k < data.length; k += 4) { seen += data[k] > 200; sum = (sum*31 + data[k]*data[k - 1]) % 1000003; }
        return [seen, sum];
    })()"""
    seen, first = tab.tell(f"goTo(0.5*page.card.pace); draw(); {count}")
    check(seen > 300, f"{seen} pixels are drawn")
    check(tab.tell(f"goTo(1.7*page.card.pace); draw(); {count}")[1] != first, "the picture stands still")


def obeys_sliders(tab, key):
    """Each slider changes something, and where it is known what, that."""
    trace = "JSON.stringify([Array.from(page.show.state(1)), Array.from(page.show.scene(1, true)), page.show.quantities().map((_, k) => Array.from(page.show.series(k, 0, 1)))])"
    knobs = tab.tell("page.card.knobs")
    for k, knob in enumerate(knobs):
        # By a way that is allowed: as far as a quarter of the range.
        low, high, value = knob["low"], knob["high"], knob["value"]
        other = value + (high - low) / 4 if value + (high - low) / 4 <= high else value - (high - low) / 4
        before = tab.tell(f"reset(); play(false); goTo(1); {trace}")
        moved = tab.tell(
            f"""(() => {{
                const input = element("knobs").querySelectorAll("input")[{k}];
                input.value = {other};
                input.dispatchEvent(new Event("input"));
                goTo(1);
                return [page.values[{k}], {trace}];
            }})()"""
        )
        check(abs(moved[0] - other) < (high - low) / 100, f"{knob['name']} is {moved[0]}, not {other}")
        check(tab.tell("element('message').textContent") == "", f"{knob['name']} = {other}: {tab.tell('element(`message`).textContent')}")
        check(moved[1] != before, f"{knob['name']} changes nothing")
        if expression := SEEN.get(key, {}).get(knob["name"]):
            seen = tab.tell(f"(s => {expression})(page.show.state(0))")
            check(abs(seen - moved[0]) < 1e-6 * max(1, abs(seen)), f"{knob['name']} is set to {moved[0]}, and seen as {seen}")
        link = tab.tell("toLink(page)")
        check(f"{knob['name']}=" in link, f"{knob['name']} is not in {link}")
        check(abs(tab.tell(f"fromLink({json.dumps(link)}, page.cards).values[{k}]") - moved[0]) < 1e-5 * max(1, abs(moved[0])), "the link loses it")
    tab.tell("reset()")


def shows_equations(tab, beyond_allowed=0):
    """They are typeset by the browser, none is cut off, and long lists are folded."""
    found = tab.tell("""(() => {
        const sizes = [...document.querySelectorAll("#formulas math")].filter(one => one.checkVisibility()).map(one => one.getBoundingClientRect());
        const { right } = element("formulas").getBoundingClientRect();
        return [sizes.length, Math.min(...sizes.map(size => size.height)), Math.max(...sizes.map(size => size.right)) - right];
    })()""")
    count, height, beyond = found
    check(count > 5 and height > 5, f"{count} formulas, the lowest {height} high")
    check(beyond < 1 + beyond_allowed, f"a formula is {beyond} wider than its place")
    check(beyond < 1 or tab.tell("getComputedStyle(document.querySelector('#formulas .equations')).overflowX === 'auto'"), "what is wider is cut off")
    check(tab.tell("[...document.querySelectorAll('#formulas mfrac')].every(one => one.getBoundingClientRect().height > one.firstElementChild.getBoundingClientRect().height)"), "fractions are not set as such")


def fits(tab, width):
    """Nothing stands out to the side."""
    wide = tab.tell("document.documentElement.scrollWidth")
    check(wide <= width, f"the page is {wide} wide")


def is_seen_at_once(tab, width, height):
    """Motion, first equation of motion, a plot with its unit, and the system in the list, without scrolling."""
    check(tab.tell("document.documentElement.scrollHeight") <= height, "the page is higher than the window")
    seen = tab.tell("""(() => {
        const heading = [...document.querySelectorAll("#formulas h5")].find(one => one.textContent === "Equations of motion");
        const first = heading.nextElementSibling.querySelector("math") ?? heading;
        const all = { scene: element("scene"), first, plot: document.querySelector("#plots canvas"), listed: document.querySelector("#systems [aria-current]") };
        return Object.entries(all).map(([name, one]) => {
            const { left, right, top, bottom } = one.getBoundingClientRect();
            return [name, left, top, right, bottom, one === document.elementFromPoint(left + 3, (top + bottom)/2) || one.contains(document.elementFromPoint(left + 3, (top + bottom)/2))];
        });
    })()""")
    for name, left, top, right, bottom, is_on_top in seen:
        is_within = left >= 0 and top >= 0 and right <= width and (bottom <= height or name == "plot" and top + 40 <= height)
        check(is_within and (is_on_top or name == "plot"), f"{name} is not seen at {width} x {height}")
    check(tab.tell("page.card.hasUnits") == (" in " in tab.tell("document.querySelector('#plots figcaption').textContent") and tab.tell("page.plots[0].unit") == "J"), "the energy's unit is not told")


def is_listed(tab, width):
    """The list shows the system that was opened, and the page is at its top."""
    left, right = tab.tell("(({ left, right }) => [left, right])(document.querySelector('#systems [aria-current]').getBoundingClientRect())")
    check(left >= 0 and right <= width, f"the list shows another system: this one is at {left} to {right}")
    check(tab.tell("scrollY") == 0, "the page is not at its top")


def test_system(tab, url, key, pictures):
    """All of one system."""
    tab.resize(1280, 800)
    tab.scheme("light")
    tab.open(f"{url}#{key}", READY)
    check(tab.tell("page.card.key") == key, "another system is shown")
    fits(tab, 1280)
    shows_equations(tab)
    is_seen_at_once(tab, 1280, 800)
    check(tab.tell("!element('loading')"), "it says that it loads when it has")
    loss = run_for_ten_seconds(tab)
    is_drawn(tab)
    obeys_sliders(tab, key)
    if pictures:
        tab.tell("play(false); goTo(4*page.card.pace)")
        tab.tell("new Promise(done => setTimeout(done, 400))")
        tab.picture(pictures / f"{key}.png")
    tab.resize(390, 844, 2, True)
    tab.scheme("dark")
    tab.tell("new Promise(done => setTimeout(done, 300))")
    fits(tab, 390)
    is_listed(tab, 390)
    # A fraction with its bracket is not broken: the equations then move sideways under a finger, by a fifth of the width.
    shows_equations(tab, beyond_allowed=390 / 5)
    if pictures:
        tab.picture(pictures / f"{key}-phone.png")
    check(not tab.complaints, "; ".join(tab.complaints))
    print(f"{key:20} {'' if loss is None else f'loses {loss:.0e} of what it conserves'}", flush=True)


def test_keyboard(tab, url):
    """Keys, the link of a page that is opened, and light and dark."""
    tab.resize(1280, 900)
    tab.scheme("light")
    tab.open(f"{url}#spherical-pendulum?theta_0=0.7&speed=2&at=1.5", READY)
    check(tab.tell("[page.card.key, page.values[0], page.speed, page.playing]") == ["spherical-pendulum", 0.7, 2, False], "the link is not obeyed")
    check(abs(tab.tell("page.t") - 1.5) < 1e-9, "nor is its time")
    expect = [
        ("ArrowRight", "Math.abs(page.t - 1.5 - 1/60) < 1e-9"),
        ("ArrowLeft", "Math.abs(page.t - 1.5) < 1e-9"),
        ("Home", "page.t === 0"),
        ("+", "page.speed === 4"),
        ("-", "page.speed === 2"),
        ("f", "page.forces === false"),
        ("r", "page.values[0] === page.card.knobs[0].value"),
        (" ", "page.playing === false"),
        (" ", "page.playing === true"),
        ("d", "document.documentElement.dataset.theme === 'dark'"),
        ("n", "page.card.key !== 'spherical-pendulum'"),
        ("p", "page.card.key === 'spherical-pendulum'"),
    ]
    for key, holds in expect:
        tab.press(key)
        tab.tell("new Promise(done => setTimeout(done, 60))")
        check(tab.tell(holds), f"the key {key!r} does not do {holds}")
    before = tab.tell("element('knobs').querySelector('input').focus(); page.values[0]")
    tab.press("ArrowRight")
    check(tab.tell("page.values[0]") > before, "a slider does not move by its keys")
    dark = tab.tell("getComputedStyle(document.body).backgroundColor")
    tab.press("d")
    check(tab.tell("getComputedStyle(document.body).backgroundColor") != dark, "dark is as light")
    check(not tab.complaints, "; ".join(tab.complaints))
    print("keys and links work", flush=True)


def test_speed(tab, url):
    """What a frame of the chain costs, and how many there are."""
    tab.resize(1280, 900)
    tab.open(f"{url}#chain", READY)
    frames = """new Promise(done => {
        page.cost = [];
        const begun = performance.now();
        setTimeout(() => done([page.cost.length / (performance.now() - begun) * 1e3, page.cost.toSorted((a, b) => a - b)]), 4000);
    })"""
    rate, cost = tab.tell(frames)
    middle, most = cost[len(cost) // 2], cost[len(cost) * 95 // 100]
    print(f"50 rods: {rate:.1f} frames a second; one costs {middle:.1f} ms, 95 % of them at most {most:.1f} ms", flush=True)
    check(middle < 1000 / 60, "a frame costs more than a sixtieth of a second")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--pictures", type=pathlib.Path)
    parser.add_argument("systems", nargs="*")
    given = parser.parse_args()
    if given.pictures:
        given.pictures.mkdir(parents=True, exist_ok=True)
    size = given.page.stat().st_size
    words = given.page.read_text().split('id="wasm"')[0]
    url = given.page.resolve().as_uri()
    failures = 0
    with Browser() as tab:
        tab.open(url, READY)
        keys = tab.tell("page.cards.map(card => card.key)")
        tests = [(key, lambda key=key: test_system(tab, url, key, given.pictures)) for key in given.systems or keys]
        tests += [("keyboard", lambda: test_keyboard(tab, url)), ("speed", lambda: test_speed(tab, url))]
        tests.append(("loading", lambda: check('id="loading"' in words, "nothing is said before the systems are there")))
        tests.append(("size", lambda: check(size < 1_500_000, f"the page has {size} bytes")))
        for name, test in tests:
            tab.complaints.clear()
            try:
                test()
            except Failed as failure:
                failures += 1
                print(f"{name}: {failure}", file=sys.stderr, flush=True)
    print(f"{len(tests) - failures} of {len(tests)} tests passed; the page has {size / 1000:.0f} kB")
    sys.exit(failures > 0)


if __name__ == "__main__":
    main()
