# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of the lessons, drawn from what the program prints: python3 lessons/figures.py PROGRAM

Flow charts, the labelled four-bar, and curves, as SVG in the folder `pictures` of each lesson. Every figure has paper of its own,
so that it can be read on a dark page, and a title for those who do not see it.
"""

import json
import math
import os
import subprocess
import sys

PROGRAM = sys.argv[1] if len(sys.argv) > 1 else "build/holonom"
PAPER, INK, FAINT = "#fbfaf6", "#22252a", "#8a9099"
COLOURS = ("#1f6fb2", "#c2491d", "#2f7d4f", "#8a5a9e")  # with different dashes, so that no one needs the colour
DASHES = ("", "7 4", "2 3", "10 3 2 3")


def ask(command):
    """What a command prints, as JSON; a run that ends early prints one too."""
    done = subprocess.run([PROGRAM, *command.split(), "--json"], capture_output=True, text=True, check=False)
    return json.loads(done.stdout)


def escape(text):
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def text(x, y, words, size=13, anchor="middle", colour=INK, style=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}" fill="{colour}" {style}>{escape(words)}</text>'


def line(x1, y1, x2, y2, colour=INK, width=1.5, extra=""):
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}" stroke-width="{width}" {extra}/>'


def write(lesson, name, title, width, height, parts):
    """One SVG file: paper, an arrowhead to use, the parts."""
    folder = os.path.join("lessons", lesson, "pictures")
    os.makedirs(folder, exist_ok=True)
    head = "".join(
        f'<marker id="head{k}" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="7" markerHeight="7" orient="auto-start-reverse">'
        f'<path d="M0 1 L10 5 L0 9 z" fill="{colour}"/></marker>'
        for k, colour in enumerate((INK, *COLOURS))
    )
    with open(os.path.join(folder, name + ".svg"), "w", encoding="utf-8") as f:
        f.write(
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" role="img" '
            f'font-family="DejaVu Sans, Helvetica, Arial, sans-serif"><title>{escape(title)}</title><defs>{head}</defs>'
            f'<rect width="{width}" height="{height}" rx="4" fill="{PAPER}"/>\n' + "\n".join(parts) + "\n</svg>\n"
        )


# ---- flow charts: each box says what is done, and the command of the program that shows it ----

MODEL = [
    ("The mechanism: bodies, joints, loops", "inspect fb0"),
    ("Cut each loop: constraints φ(q) = 0", "equations fb0"),
    ("Differentiate twice: J and γ", "terms fb0"),
    ("The open chain: M and h", "terms fb0-lagrangian"),
    ("Close it again: multipliers λ, force J'λ", "terms fb0 --reactions"),
    ("Choose: all coordinates with λ, or reduced ones", "list methods"),
    ("Integrate, and check gap and energy", "compare fb0 --time 1"),
]
STEP = [
    ("State (q, v) at time t", "terms fb0"),
    ("M, f, J, γ at the state of this stage", "terms fb0 --q th1=1.2"),
    ("Solve the saddle-point system: a, λ", "terms fb0 --json"),
    ("Next stage, until the step to t + h is complete", "run fb0 --method index1@rk4:h=0.01 --time 0.01"),
    ("Project q, then v, in the measure of M", "run fb0 --method projection@rk4:h=0.01 --time 0.01"),
    ("Check gap and energy; go on from t + h", "run fb0 --method projection@rk4:h=0.01 --time 1 --plot"),
]
PROBLEM = [
    ("Start: assemble q, then v with J v = 0", "inspect fb0"),
    ("Assemble M, f, J, γ", "terms fb0"),
    ("Solve for a and λ, at every stage", "problem p5 --hint 1"),
    ("Integrate v and q to the next time", "run fb0 --method index1@rk4:h=0.01 --time 1"),
    ("Project: position first, then velocity", "compare fb0 --methods index1@rk4:h=0.01 projection@rk4:h=0.01 --time 1"),
    ("Solve once more if λ is wanted", "run fb0 --method projection@rk4:h=0.01 --time 1 --reactions"),
]


MOST = 52  # characters in a line of a box


def typed(x, y, command):
    """A command in one line or two, marked so that a test can run it."""
    at = len(command) if len(command) <= MOST else command.rfind(" ", 0, MOST)
    rest = command[at:].strip()
    more = f'<tspan x="{x:.1f}" dy="16"> {escape(rest)}</tspan>' if rest else ""
    style = 'class="command" font-family="DejaVu Sans Mono, monospace"'
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="13" text-anchor="middle" fill="#1f5c93" {style}>{escape(command[:at])}{more}</text>'


def flow(lesson, name, title, boxes, back=None):
    """Boxes below each other with arrows; `back` (from, to, word) is an arrow on the right that returns."""
    two_lines = any(len("holonom " + command) > MOST for _, command in boxes)
    width, tall, gap, left, wide = 544 if back else 474, 66 if two_lines else 56, 20, 14, 446
    parts = []
    for k, (words, command) in enumerate(boxes):
        y = 20 + k * (tall + gap)
        lower = 8 if two_lines and len("holonom " + command) <= MOST else 0  # a box of one line in the middle
        parts.append(f'<rect x="{left}" y="{y}" width="{wide}" height="{tall}" rx="5" fill="#ffffff" stroke="{INK}" stroke-width="1.3"/>')
        parts.append(text(left + wide / 2, y + 23 + lower, f"{k + 1}. {words}", 15))
        parts.append(typed(left + wide / 2, y + 42 + lower, "holonom " + command))
        if k:
            parts.append(line(left + wide / 2, y - gap, left + wide / 2, y - 2, extra='marker-end="url(#head0)"'))
    if back:
        start, end = (20 + k * (tall + gap) + tall / 2 for k in back[:2])
        x = left + wide
        parts.append(
            f'<path d="M{x} {start} H{x + 36} V{end} H{x + 3}" fill="none" stroke="{INK}" stroke-width="1.5" marker-end="url(#head0)"/>'
        )
        middle = (start + end) / 2
        parts.append(text(x + 52, middle, back[2], 12, style=f'transform="rotate(90 {x + 52} {middle})"'))
    write(lesson, name, title, width, 20 + len(boxes) * (tall + gap) + 4, parts)


# ---- the labelled four-bar ----


def arc(cx, cy, r, angle):
    """The angle from the x axis, as an arc with an arrowhead."""
    large = 1 if angle > math.pi else 0
    x, y = cx + r * math.cos(angle), cy - r * math.sin(angle)
    return (
        f'<path d="M{cx + r:.1f} {cy:.1f} A{r} {r} 0 {large} 0 {x:.1f} {y:.1f}" fill="none" stroke="{FAINT}" stroke-width="1.2" marker-end="url(#head0)"/>'
    )


def ground(x, y):
    hatch = "".join(line(x - 13 + 6.5 * k, y + 14, x - 18 + 6.5 * k, y + 21, FAINT, 1) for k in range(5))
    return f'<path d="M{x} {y} L{x - 10:.1f} {y + 14} H{x + 10:.1f} z" fill="none" stroke="{INK}" stroke-width="1.3"/>{line(x - 15, y + 14, x + 15, y + 14)}{hatch}'


def pin(x, y):
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4.5" fill="{PAPER}" stroke="{INK}" stroke-width="1.6"/>'


def link(a, b, colour, label, name):
    """A bar, its centre of mass, its length, and its number."""
    mx, my = (a[0] + b[0]) / 2, (a[1] + b[1]) / 2
    n = math.hypot(b[0] - a[0], b[1] - a[1])
    ux, uy = (a[1] - b[1]) / n, (b[0] - a[0]) / n  # to the right of the bar
    return [
        line(*a, *b, colour, 5, 'stroke-linecap="round"'),
        f'<circle cx="{mx:.1f}" cy="{my:.1f}" r="5.5" fill="{PAPER}" stroke="{INK}"/><path d="M{mx} {my} V{my - 5.5} A5.5 5.5 0 0 1 {mx + 5.5} {my} z M{mx} {my} V{my + 5.5} A5.5 5.5 0 0 1 {mx - 5.5} {my} z" fill="{INK}"/>',
        text(mx - 12 * ux, my - 16 * uy + 4, label, 16, "end" if ux > 0 else "start"),
        text(mx + 12 * ux, my + 16 * uy + 4, name, 14, "start" if ux > 0 else "end", "#555"),
    ]


def four_bar():
    """fb0 at its start: lengths, angles, centres of mass; and cut at B, with the forces that close it."""
    at = ask("terms fb0-lagrangian")
    q, push = at["q"], at["lambda"]
    scale, ox, oy = 140, 90, 320

    def place(x, y):
        return ox + scale * x, oy - scale * y

    o1, o3 = place(0, 0), place(2.2, 0)
    a = place(math.cos(q[0]), math.sin(q[0]))
    b = place(math.cos(q[0]) + 2 * math.cos(q[1]), math.sin(q[0]) + 2 * math.sin(q[1]))
    names = (("ℓ₁ = 1 m", "crank"), ("ℓ₂ = 2 m", "coupler"), ("ℓ₃ = 1.8 m", "rocker"))
    bars = [part for ends, c, n in zip(((o1, a), (a, b), (o3, b)), COLOURS, names) for part in link(*ends, c, *n)]
    angles = [part for k, (centre, r) in enumerate(((o1, 34), (a, 52), (o3, 34))) for part in (
        line(*centre, centre[0] + r + 18, centre[1], FAINT, 1, 'stroke-dasharray="4 3"'), arc(*centre, r, q[k]),
        text(centre[0] + r + (14 if k != 1 else -8), centre[1] + (-12 if k != 1 else 16), f"θ{'₁₂₃'[k]} = {q[k]:.3g} rad", 14, "start"))]  # fmt: skip
    below = oy + 46
    base = [ground(*o1), ground(*o3), line(o1[0], below, o3[0], below, INK, 1.2, 'marker-start="url(#head0)" marker-end="url(#head0)"'),
            text((o1[0] + o3[0]) / 2, below + 18, "d = 2.2 m", 16)]  # fmt: skip
    pins = [pin(*p) for p in (o1, a, b, o3)]
    tags = [text(o1[0] - 18, o1[1] + 5, "O₁", 15), text(a[0] - 14, a[1] - 10, "A", 15), text(b[0] + 14, b[1] - 8, "B", 15), text(o3[0] - 20, o3[1] + 5, "O₃", 15)]
    write("01-closed-loops", "four-bar-labelled", "The four-bar fb0 at its start, with lengths, angles and centres of mass", 600, 400,
          base + bars + angles + pins + tags)  # fmt: skip

    # cut at B: both halves of the joint apart, and the force on each
    c = (b[0] + 46, b[1] + 4)
    p3 = (o3[0] + 46, o3[1])
    size = 9.0
    force = [line(b[0], b[1], b[0] + size * push[0], b[1] - size * push[1], COLOURS[0], 2.6, 'marker-end="url(#head1)"'),
             line(c[0], c[1], c[0] - size * push[0], c[1] + size * push[1], COLOURS[1], 2.6, 'marker-end="url(#head2)"'),
             text(b[0] - 12, b[1] - 52, f"λ = ({push[0]:.3g}, {push[1]:.3g}) N on the coupler", 19, "end"),
             text(c[0] + 14, c[1] + 50, "−λ on the rocker", 19, "start")]  # fmt: skip
    cut = [line(b[0] + 23, b[1] - 40, b[0] + 23, b[1] + 70, FAINT, 1.2, 'stroke-dasharray="5 4"'), text(b[0] + 28, b[1] - 44, "cut at B", 17, "start", "#555")]
    plain = [line(*o1, *a, COLOURS[0], 5), line(*a, *b, COLOURS[1], 5), line(*p3, *c, COLOURS[2], 5)]
    write("02-equations-of-motion", "cut-loop", "The loop cut at B: an open chain, and the pair of forces that closes it again", 660, 380,
          [ground(*o1), ground(*p3), *plain, *[pin(*p) for p in (o1, a, b, c, p3)], *cut, *force])  # fmt: skip


# ---- curves ----


def ticks(low, high, log):
    if log:
        tens = range(math.floor(math.log10(low)), math.floor(math.log10(high) + 1e-9) + 1)
        found = [10.0**k for k in tens if 10.0**k >= low * (1 - 1e-9)]
        few = len(found) < 3  # too few to read a slope from
        return [m * 10.0**k for k in tens for m in (1, 2, 5) if low * (1 - 1e-9) <= m * 10.0**k <= high * (1 + 1e-9)] if few else found
    step = 10 ** math.floor(math.log10((high - low) / 4))
    step *= next(m for m in (1, 2, 5, 10) if (high - low) / (m * step) <= 6)
    return [k * step for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]


def label(v, log):
    if log:
        return "10" + "".join("⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".index(c)] for c in f"{round(math.log10(v))}")
    return f"{v:.6g}".replace("-", "−")


def plot(lesson, name, title, x_name, y_name, curves, logx=False, logy=False, dots=False):
    """Curves [(label, xs, ys)] with axes; not a number and, on a logarithmic axis, zero are left out."""
    width, height, left, right, top, bottom = 480, 330, 78, 16, 22 + 19 * len(curves), 54
    clean = [(w, [(x, y) for x, y in zip(xs, ys) if math.isfinite(y) and (not logy or y > 0)]) for w, xs, ys in curves]
    xs = [x for _, points in clean for x, _ in points]
    ys = [y for _, points in clean for _, y in points]
    fx, fy = (math.log10 if logx else float), (math.log10 if logy else float)
    x0, x1, y0, y1 = min(map(fx, xs)), max(map(fx, xs)), min(map(fy, ys)), max(map(fy, ys))
    y0, y1 = (math.floor(y0), math.ceil(y1)) if logy else (y0 - 0.05 * (y1 - y0), y1 + 0.05 * (y1 - y0))

    def px(x):
        return left + (fx(x) - x0) / (x1 - x0) * (width - left - right)

    def py(y):
        return height - bottom - (fy(y) - y0) / (y1 - y0) * (height - top - bottom)

    parts = []
    columns = ticks(10**x0 if logx else x0, 10**x1 if logx else x1, logx)
    powers = logx and all(abs(math.log10(v) % 1) < 1e-9 for v in columns)
    for v in columns:
        parts += [line(px(v), height - bottom, px(v), top, "#e2dfd6", 1), text(px(v), height - bottom + 18, label(v, powers), 13)]
    rows = ticks(10**y0 if logy else y0, 10**y1 if logy else y1, logy)
    for v in rows[:: max(1, math.ceil(len(rows) / 8))]:
        parts += [line(left, py(v), width - right, py(v), "#e2dfd6", 1), text(left - 8, py(v) + 4, label(v, logy), 13, "end")]
    parts += [line(left, height - bottom, width - right, height - bottom), line(left, height - bottom, left, top)]
    parts += [text((left + width - right) / 2, height - 14, x_name, 14),
              text(18, (top + height - bottom) / 2, y_name, 14, style=f'transform="rotate(-90 18 {(top + height - bottom) / 2})"')]  # fmt: skip
    for k, (words, points) in enumerate(clean):
        stroke = f'stroke="{COLOURS[k]}" stroke-width="2" stroke-dasharray="{DASHES[k]}"'
        path = " ".join(f"{px(x):.1f},{py(y):.1f}" for x, y in points)
        parts.append(f'<polyline points="{path}" fill="none" {stroke}/>')
        parts += [f'<circle cx="{px(x):.1f}" cy="{py(y):.1f}" r="4" fill="{COLOURS[k]}"/>' for x, y in points] if dots else []
        parts += [f'<line x1="{left}" y1="{16 + 19 * k}" x2="{left + 34}" y2="{16 + 19 * k}" {stroke}/>', text(left + 42, 20 + 19 * k, words, 13, "start")]
    write(lesson, name, title, width, height, parts)


def samples(scene, method, time, every, column):
    """(times, values) of one run; `column` is a coordinate, a rate, or a name of the samples."""
    run = ask(f"run {scene} --method {method} --time {time} --every {every}")
    s = run["samples"]
    for names, key in ((run["coordinates"], "q"), (run["rates"], "v"), (run["rows"], "lambda")):
        if column in names:
            return s["t"], [row[names.index(column)] for row in s[key]]
    return s["t"], s[column]


def curves():
    methods = (("right", "nullspace@rk4:h=0.01"), ("without the term, as printed", "nullspace-as-printed@rk4:h=0.01"))
    plot("03-null-space", "missing-term", "Energy of the four-bar by the projected equation with and without its second term", "time in s",
         "energy in J", [(w, *samples("four-bar", m, 1, 0.01, "energy")) for w, m in methods])  # fmt: skip

    run = ask("run fb0-lagrangian --method projection@rk4:h=0.001 --time 2 --every 0.02")
    turn = [q for q in run["samples"]["q"] if q[0] < 1 + 2 * math.pi]
    found = [ask("terms fb0-lagrangian --q " + " ".join(f"{c}={x!r}" for c, x in zip(run["coordinates"], q))) for q in turn]
    plot("04-reduced-coordinates", "reduced-mass", "Reduced mass of fb0 over one turn of its crank", "crank angle in rad",
         "reduced mass in kg m²", [("M_r: the mass that the crank feels", [q[0] for q in turn], [d["reduced"]["M_r"][0][0] for d in found])])  # fmt: skip

    names = (("crank θ₁", "th1"), ("coupler θ₂", "th2"), ("rocker θ₃", "th3"))
    plot("05-four-bar", "angles", "The three angles of fb0 in two seconds", "time in s", "angle in rad",
         [(w, *samples("fb0-lagrangian", "projection@rk4:h=0.001", 2, 0.02, c)) for w, c in names])  # fmt: skip

    names = (("nothing done: index1", "index1@rk4:h=0.01"), ("Baumgarte, alpha = beta = 5", "baumgarte:alpha=5,beta=5@rk4:h=0.01"),
             ("projection after each step", "projection@rk4:h=0.01"))  # fmt: skip
    plot("06-drift", "gap", "Loop gap of the four-bar by three methods, RK4 with a step of 0.01 s", "time in s", "gap in m",
         [(w, *samples("four-bar", m, 20, 0.1, "gap")) for w, m in names], logy=True)  # fmt: skip

    steps = [0.04, 0.02, 0.01, 0.005, 0.0025, 0.00125]
    best = samples("pendulum", "index1@dop853:rtol=1e-13,atol=1e-14", 1, 1, "th")[1][-1]
    names = (("explicit Euler, order 1", "euler"), ("Heun, order 2", "heun"), ("classical Runge-Kutta, order 4", "rk4"))
    plot("07-integrators", "orders", "Error of the pendulum's angle after one second over the step, three integrators", "step in s", "error in rad",
         [(w, steps, [abs(samples("pendulum", f"index1@{m}:h={h}", 1, 1, "th")[1][-1] - best) for h in steps]) for w, m in names],
         logx=True, logy=True, dots=True)  # fmt: skip

    dampers = ["1e2", "1e3", "1e4", "1e5"]
    names = (("explicit: projection@dopri5", "projection@dopri5"), ("implicit: ggl@radau5", "ggl@radau5"))
    plot("08-hard-cases", "stiff-cost", "Steps for one second of a four-bar with a stiff damper in its joint, tolerance 1e-6", "damping in N m s/rad", "steps",
         [(w, [float(c) for c in dampers],
           [ask(f"compare stiff-four-bar --set k=1e4 --set c={c} --methods {m}:rtol=1e-6 --time 1")["methods"][0]["steps"] for c in dampers])
          for w, m in names], logx=True, logy=True, dots=True)  # fmt: skip

    run = ask("run spinning-block --method projection@rk4:h=0.001 --time 20 --every 0.05")
    plot("09-space-and-drives", "middle-axis", "Angular velocity of the spinning block along its own three axes", "time in s", "angular velocity in rad/s",
         [(w, run["samples"]["t"], [v[-3 + k] for v in run["samples"]["v"]]) for k, w in enumerate(("first axis", "second axis", "third axis"))])  # fmt: skip


def main():
    flow("02-equations-of-motion", "chart-model", "From a mechanism to a simulation, in seven steps", MODEL)
    flow("06-drift", "chart-step", "One time step with projection", STEP, (3, 1, "every stage"))
    flow("06-drift", "chart-problem", "The steps of a constrained simulation", PROBLEM, (5, 1, "next time step"))
    four_bar()
    curves()


if __name__ == "__main__":
    main()
