#!/usr/bin/env python3
"""Tests the page in a headless Chromium.

    test.py PAGE [--pictures FOLDER]

Types five systems, and reads equations, motion and errors back; opens all systems to begin with, a link, a text that takes too long,
and the page on a phone.
"""

import argparse
import json
import math
import pathlib
import statistics
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "gallery"))
from chromium import Browser, Failed  # noqa: E402

READY = "page.took !== null && page.run !== null"
SPRING = "#[coordinates(x)]\n#[lagrangian(m/2*x_dot^2 - k/2*x^2)]\nstruct Spring { m: f64, k: f64 }"


def check(holds, what):
    """Raises where it does not hold."""
    if not holds:
        raise Failed(what)


def wait(tab, holds, milliseconds=3000):
    """Waits until this holds."""
    tab.tell(f"""new Promise((done, failed) => {{
        const begun = performance.now();
        const look = () => {{
            if ({holds}) done(true);
            else if (performance.now() - begun > {milliseconds}) failed(new Error({json.dumps(holds)} + " does not hold in time"));
            else setTimeout(look, 5);
        }};
        look();
    }})""")


def type_text(tab, text):
    """Types a text in the place of that which is there, as a user does: select all, insert."""
    tab.tell("(() => { page.took = null; page.run = null; element('text').focus(); element('text').select(); })()")
    tab.ask("Input.insertText", text=text)


def set_number(tab, name, value):
    """Types a number into the field of this name."""
    tab.tell(f"""(() => {{
        const input = document.querySelector(`input[aria-label="{name}"]`);
        input.value = {value};
        input.dispatchEvent(new Event("input"));
        page.run = null;
    }})()""")


def state(tab, frame):
    """Coordinates and velocities in a frame."""
    width = "2*page.found.coordinates.length"
    return tab.tell(f"Array.from(page.run.states.slice({frame}*{width}, ({frame} + 1)*{width}))")


def test_spring(tab, _):
    """cos t, by each method."""
    type_text(tab, SPRING)
    wait(tab, READY)
    check("ẍ" in tab.tell("element('formulas').textContent") or tab.tell("document.querySelectorAll('#formulas math').length") > 3, "no equations")
    check("energy (proved)" in tab.tell("element('facts').textContent"), "the energy is not told to be conserved")
    set_number(tab, "k", 4)
    wait(tab, READY.replace("page.took !== null && ", ""))
    for method in ["RungeKutta4", "Dopri5", "Dop853"]:
        tab.tell(f"element('method').value = '{method}'; page.run = null; element('method').dispatchEvent(new Event('input'))")
        wait(tab, "page.run")
        x, v = state(tab, 900)
        check(abs(x - math.cos(20)) < 1e-6 and abs(v + 2 * math.sin(20)) < 1e-6, f"{method}: x = {x}, v = {v}")


def test_constraint(tab, _):
    """The bob of a pendulum on a rod stays on it; a start beside it is projected."""
    type_text(tab, "#[coordinates(x, y)]\n#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y)]\n#[constraint(rod: x^2 + y^2 = l^2)]\nstruct Bob { m: f64, g: f64, l: f64 }")
    wait(tab, READY)
    for frame in [0, 450, 900]:
        x, y, u, v = state(tab, frame)
        check(abs(math.hypot(x, y) - 1) < 1e-12 and abs(x * u + y * v) < 1e-11, f"off the rod: {x, y, u, v}")
    check(tab.tell("page.plots.some(plot => plot.title.startsWith('Multipliers'))"), "no multipliers")
    check(tab.tell("page.track[0].length") == 1, "x and y are no point")


def test_family(tab, _):
    """Arrays of parameters and of coordinates: two masses on springs swing in their modes."""
    type_text(tab, "#[coordinates(x: [2])]\n#[lagrangian(sum(i in 0..2, m[i]/2*x_dot[i]^2 - k[i]/2*x[i]^2))]\nstruct Two { m: [f64; 2], k: [f64; 2] }")
    wait(tab, READY)
    set_number(tab, "k[1]", 9)
    set_number(tab, "x[1]", 1)
    wait(tab, "page.run && page.set.start['x[1]'][0] === 1")
    x, y = state(tab, 900)[:2]
    check(abs(x - math.cos(10)) < 1e-7 and abs(y - math.cos(30)) < 1e-6, f"{x, y}")


def test_nonholonomic(tab, _):
    """A knife edge slides along its direction."""
    type_text(tab, "#[coordinates(x, y, theta)]\n#[lagrangian(m/2*(x_dot^2 + y_dot^2) + j/2*theta_dot^2 + m*g*x)]\n#[constraint(edge: x_dot*sin(theta) - y_dot*cos(theta) = 0)]\nstruct Knife { m: f64, j: f64, g: f64 }")
    wait(tab, READY)
    x, y, theta, u, v, w = state(tab, 900)
    check(abs(u * math.sin(theta) - v * math.cos(theta)) < 1e-12, "it slips")
    check("edge" in tab.tell("element('formulas').textContent") or tab.tell("page.found.constraints.length") == 1, "no constraint")


def test_errors(tab, _):
    """Errors are underlined at their tokens, with the compiler's text; what was there before stays, and comes back."""
    type_text(tab, SPRING)
    wait(tab, READY)
    tab.tell("(() => { const text = element('text'); text.focus(); text.setSelectionRange(54, 54); })()")
    type_text(tab, SPRING.replace("k/2*x^2", "kk/2*x^2 + y"))
    wait(tab, "document.querySelectorAll('mark').length === 2")
    check(tab.tell("Array.from(document.querySelectorAll('mark'), mark => mark.textContent)") == ["kk", "y"], "other tokens are underlined")
    first, second = tab.tell("Array.from(element('faults').children, item => item.textContent)")
    check(first.startswith("2:28: nothing is called `kk`"), first)
    check(second.startswith("2:39: nothing is called `y`"), second)
    for text in ["", "struct", "struct S {", "#[lagrangian(", "#[coordinates(x)] struct S;", "\\", "ẍ = 0", "#[coordinates(x)] #[lagrangian(x_dot^2/2)] struct S { x: f64 }"]:
        type_text(tab, text)
        wait(tab, "element('faults').children.length > 0")
    type_text(tab, "#[coordinates(x)]\n#[lagrangian(x_dot^2/2)]\n#[contact(floor: x >= 0, restitution: 1)]\nstruct Ball { floor: Contact }")
    wait(tab, "element('message').textContent.includes('`floor` opens and closes a constraint')")
    type_text(tab, SPRING)
    wait(tab, READY + " && element('faults').children.length === 0")


def test_runaway(tab, _):
    """A text that takes long is given up, and the page goes on."""
    many = f"#[coordinates(x: [60])]\n#[lagrangian(sum(i in 0..60, sum(j in 0..60, sum(k in 0..60, sin(x[i]*x[j] + cos(x[k]*i + j))*x_dot[i]*x_dot[j]*x_dot[k]^2))))]\nstruct S;"
    links = "#[coordinates(q: [40])]\n#[lagrangian(sum(i in 0..40, sum(j in 0..40, cos(q[i] - q[j])*q_dot[i]*q_dot[j]/(1 + i + j)^2)))]\nstruct Links;"
    for text, told in [(many, "grows beyond"), (links, "longer than a second")]:
        type_text(tab, text)
        longest = tab.tell("""new Promise(done => {
            const [begun, gaps] = [performance.now(), []];
            let last = begun;
            const look = now => {
                gaps.push(now - last);
                last = now;
                if (now - begun < 1600) setTimeout(() => look(performance.now()), 4);
                else done(Math.max(...gaps));
            };
            look(begun);
        })""")
        check(longest < 300, f"the page stands still for {longest:.0f} ms")
        wait(tab, "element('faults').children.length > 0")
        check(told in tab.tell("element('faults').textContent"), tab.tell("element('faults').textContent"))
    type_text(tab, SPRING)
    wait(tab, READY)


def test_begin_with(tab, url):
    """Each system moves to its end, keeps its energy where that is conserved, and has points; a link holds all of it."""
    for key in tab.tell("SYSTEMS.map(({ key }) => key)"):
        tab.open(f"{url}#{key}", READY)
        check(tab.tell("element('message').textContent") == "", f"{key}: {tab.tell('element(`message`).textContent')}")
        check(tab.tell("page.track[0].length") > 0, f"{key} has no points")
        check(tab.tell("Array.from(page.run.states).every(Number.isFinite)"), f"{key} is not finite")
        loss = tab.tell("(([first, ...rest]) => Math.max(...rest.map(e => Math.abs(e - first))) / Math.max(...rest.map(Math.abs), 1))(Array.from(page.run.energies))")
        conserves = "energy" in tab.tell("page.found.conserved")
        check(not conserves or loss < 1e-6, f"{key} loses {loss:.1e} of its energy")
        print(f"  {key:20} equations after {tab.tell('page.took'):.0f} ms" + (f", loses {loss:.0e} of its energy" if conserves else ""))
    set_number(tab, "theta", 0.7)
    wait(tab, "page.run")
    link = tab.tell("location.href")
    tab.open(link, READY)
    check(tab.tell("page.set.start.theta[0]") == 0.7, "the link loses a number")


def test_program(tab, _):
    """The program has text and numbers."""
    type_text(tab, SPRING)
    wait(tab, READY)
    tab.tell("showProgram()")
    program = tab.tell("document.querySelector('dialog pre').textContent")
    check("#[derive(Lagrangian)]\n#[coordinates(x)]" in program and "let system = Spring { m: 1.0, k: " in program, program)
    tab.tell("element('close').click()")


def test_speed(tab, _):
    """From a keystroke to equations, for the systems to begin with."""
    took = []
    for text in tab.tell("SYSTEMS.map(({ set }) => set.text)"):
        type_text(tab, text)
        begun = tab.tell("performance.now()")
        wait(tab, "page.took !== null")
        took.append(tab.tell("performance.now()") - begun)
    print(f"  from a keystroke to equations: {statistics.median(took):.0f} ms in the middle, {max(took):.0f} ms at most")
    check(statistics.median(took) < 100, "equations come late")


def test_sizes(tab, url, pictures):
    """Nothing stands out to the side, in a window and on a phone."""
    for width, height, ratio, mobile, scheme in [(1280, 800, 1, False, "light"), (390, 844, 2, True, "dark")]:
        tab.resize(width, height, ratio, mobile)
        tab.scheme(scheme)
        for key in ["double-pendulum", "rods", "heavy-top"]:
            tab.open(f"{url}#{key}", READY)
            wide = tab.tell("document.documentElement.scrollWidth")
            check(wide <= width, f"the page is {wide} wide at {width}")
            tab.tell("new Promise(done => setTimeout(done, 700))")
            if pictures:
                tab.picture(pictures / f"{key}-{width}.png", whole=mobile)
    tab.resize(1280, 800)
    type_text(tab, SPRING.replace("k/2*x^2", "kk/2*x^2 + y"))
    wait(tab, "document.querySelectorAll('mark').length === 2")
    if pictures:
        tab.picture(pictures / "errors-1280.png")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--pictures", type=pathlib.Path)
    given = parser.parse_args()
    if given.pictures:
        given.pictures.mkdir(parents=True, exist_ok=True)
    size = given.page.stat().st_size
    url = given.page.resolve().as_uri()
    tests = [test_spring, test_constraint, test_family, test_nonholonomic, test_errors, test_runaway, test_program, test_speed, test_begin_with]
    tests.append(lambda tab, url: test_sizes(tab, url, given.pictures))
    failures = 0
    with Browser() as tab:
        tab.resize(1280, 800)
        tab.open(url, READY)
        for test in tests:
            tab.complaints.clear()
            name = test.__name__.removeprefix("test_")
            try:
                test(tab, url)
                check(not tab.complaints, "; ".join(tab.complaints))
                print(name, flush=True)
            except Failed as failure:
                failures += 1
                print(f"{name}: {failure}", file=sys.stderr, flush=True)
    failures += size > 4_000_000
    print(f"{len(tests) - failures} of {len(tests)} tests passed; the page has {size / 1000:.0f} kB")
    sys.exit(failures > 0)


if __name__ == "__main__":
    main()
