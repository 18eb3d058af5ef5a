# SPDX-License-Identifier: GPL-3.0-or-later
# Pictures of pixels in the terminal workbench: a terminal that answers as one with kitty graphics or sixels gets them, and they show what was
# painted; every other terminal gets characters, and no byte that it could show.
import base64
import fcntl
import math
import os
import re
import struct
import sys
import termios
import time
import unittest
import zlib

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402
from terminal import METHODS, PATIENCE, ROOT, Terminal  # noqa: E402

CELL = (10, 18)  # [px]; bands of six rows fill cells of 18
BRAILLE = rb"\xe2[\xa0-\xa3][\x80-\xbf]"
GRAPHICS = re.compile(rb"\033_G([^;\033]*)(?:;([^\033]*))?\033\\")
SIXELS = re.compile(rb"\0337\033\[(\d+);(\d+)H\033P0;1q([^\033]*)\033\\\0338")


def surface(name, theme="DARK"):
    """A colour of a theme, from the table of colours: (red, green, blue)."""
    with open(os.path.join(ROOT, "core", "render", "look.c"), encoding="utf-8") as file:
        values = re.search(r"\[HN_THEME_%s\] = \{([^}]*)\}" % theme, file.read()).group(1).split(",")
    value = int(values[("paper", "raised", "ink", "muted", "hairline", "tear").index(name)], 16)
    return value >> 16, value >> 8 & 255, value & 255


def decode_sixels(text):
    """(width, height, rows of pixels) of a picture whose every pixel is painted."""
    width, height = (int(v) for v in re.match(r'"1;1;(\d+);(\d+)', text).groups())
    rows = [[None] * width for _ in range(height)]
    colours, colour, x, top = {}, 0, 0, 0
    for token in re.finditer(r"#(\d+);2;(\d+);(\d+);(\d+)|#(\d+)|!(\d+)([?-~])|([?-~])|([$-])", text[text.index("#"):]):
        define, red, green, blue, use, count, repeated, single, move = token.groups()
        if define:
            colours[int(define)] = tuple(round(255 * int(v) / 100) for v in (red, green, blue))
        elif use:
            colour = int(use)
        elif move:
            x = 0
            top += 6 if move == "-" else 0
        else:
            bits = ord(repeated or single) - 63
            for _ in range(int(count or 1)):
                for k in range(6):
                    if bits >> k & 1:
                        rows[top + k][x] = colours[colour]
                x += 1
    return width, height, rows


def near(pixel, colour):
    return max(abs(a - b) for a, b in zip(pixel, colour)) < 60


def pivots(rows):
    """[(x, y)] of the two supports, in pixels: the ring in the colour of the selected method above each line of ground."""
    blue, muted, found = (0x6B, 0x99, 0xDB), surface("muted"), []
    for y in range(len(rows) - 60):  # below is the bar of known length
        for run in re.finditer("#{25,}", "".join("#" if near(pixel, muted) else " " for pixel in rows[y])):
            x = (run.start() + run.end() - 1) // 2
            column = "".join("#" if near(rows[k][x], blue) else " " for k in range(y, 0, -1))
            lower, upper = list(re.finditer("#+", column))[:2]
            if not any(abs(x - other[0]) < 10 for other in found):
                found.append((x, y - (lower.start() + upper.end() - 1) / 2))
    return sorted(found)


def decode_pixels(width, height, data):
    return [[tuple(data[3 * (y * width + x):3 * (y * width + x) + 3]) for x in range(width)] for y in range(height)]


class Shown(Terminal):
    """A terminal that answers what it is asked. name: its answer to 'who are you', None: none; kitty: it knows the graphics protocol; pixels: its
    line says how large it is, else it says so when it is asked; late: [s] until it has read a picture; background: its answer to 'which background',
    None: none; piecemeal: answers come byte by byte; parted: [s] between the first byte of an answer and the others."""

    def __init__(self, *words, name=None, kitty=False, pixels=True, late=0.0, background=None, piecemeal=False, parted=0.0, **more):
        self.background, self.parted = background, parted
        self.name, self.kitty, self.late, self.piecemeal = name, kitty, late, piecemeal
        self.images = {}  # of kitty: number -> (keys, rows of pixels)
        self.pieces = b""
        self.done = 0  # bytes of `seen` that are understood
        self.columns, self.rows = more.get("columns", 100), more.get("rows", 30)
        self.pixels = pixels
        super().__init__(*words, **more)

    def before_start(self, slave):
        if self.pixels:
            fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", self.rows, self.columns, self.columns * CELL[0], self.rows * CELL[1]))

    def answer(self, text):
        if self.parted:
            os.write(self.master, text[:1])
            time.sleep(self.parted)
            text = text[1:]
        for piece in ([bytes([c]) for c in text] if self.piecemeal else [text]):
            os.write(self.master, piece)
            time.sleep(0.06 if self.piecemeal else 0)

    def read(self, seconds=0.05):
        super().read(seconds)
        question = re.compile(rb"\033\[14t|\033\]11;\?\a|\033\[c|\033\[5n|\033_G[^\033]*\033\\|\033P[^\033]*\033\\")
        for found in question.finditer(self.seen, self.done):
            self.done = found.end()
            self.obey(found.group())

    def obey(self, question):
        if question == b"\033[14t" and not self.pixels and self.name:
            self.answer(b"\033[4;%d;%dt" % (self.rows * CELL[1], self.columns * CELL[0]))
        elif question == b"\033]11;?\a":
            self.answer(self.background or b"")
        elif question == b"\033[c" and self.name:
            self.answer(self.name)
        elif question == b"\033[5n" and self.name:
            time.sleep(self.late)
            self.answer(b"\033[0n")
        elif question.startswith(b"\033_G"):
            self.take_graphics(*GRAPHICS.fullmatch(question).groups())

    def take_graphics(self, keys, payload):
        keys = dict(pair.split("=") for pair in keys.decode().split(","))
        if keys.get("a") == "q":
            if self.kitty:
                self.answer(b"\033_Gi=%d;OK\033\\" % int(keys["i"]))
        elif keys.get("a") == "d":
            for number in [int(keys["i"])] if keys["d"] == "I" else list(self.images):
                self.images.pop(number, None)
        else:
            self.keys = keys if keys.get("a") == "T" else self.keys
            self.pieces = payload if keys.get("a") == "T" else self.pieces + payload
            if keys["m"] == "0":
                width, height = int(self.keys["s"]), int(self.keys["v"])
                data = zlib.decompress(base64.b64decode(self.pieces))
                assert len(data) == 3 * width * height, "a picture has three bytes a pixel"
                self.images[int(self.keys["i"])] = (self.keys, data)

    def clear(self):
        self.read()
        self.seen = b""
        self.done = 0

    def until(self, condition):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            self.read()
            if condition():
                return True
        return False

    def sixels(self):
        return SIXELS.findall(self.seen)


METHOD_COLOURS = {(0x6B, 0x99, 0xDB), (0xE1, 0x80, 0x0E), (0x3F, 0xE4, 0x9C)}  # of the first three, on slate (render/look.c)
KITTY = {"name": b"\033[?62;c", "kitty": True}
SIXEL = {"name": b"\033[?64;1;2;4;22c"}


class Pictures(unittest.TestCase):
    def open(self, *words, **more):
        terminal = Shown(*words, **more)
        self.addCleanup(terminal.close)
        self.assertTrue(terminal.wait_for(rb"paused"))
        terminal.type(" ")
        self.assertTrue(terminal.wait_for(rb"running"))
        return terminal

    def at_the_start(self, terminal):
        """The picture of the start, once it has been sent."""
        terminal.type(" \x7f")
        self.assertTrue(terminal.wait_for(rb"0\.000"))
        steady = [None, 0.0]

        def same_for_a_second():
            shown = dict(terminal.images) or terminal.sixels()[-1:]
            if shown != steady[0]:
                steady[:] = [shown, time.monotonic()]
            return bool(shown) and time.monotonic() - steady[1] > 1.0

        self.assertTrue(terminal.until(same_for_a_second))
        return steady[0]

    def kitty_at_the_start(self):
        terminal = self.open("four-bar", *METHODS, "--pictures", "kitty", **KITTY)
        images = self.at_the_start(terminal)
        self.assertEqual(len(images), 1)
        (keys, data), = images.values()
        return terminal, keys, decode_pixels(int(keys["s"]), int(keys["v"]), data)

    def test_kitty_gets_the_mechanism_as_pixels_in_its_place(self):
        terminal, keys, rows = self.kitty_at_the_start()
        # of 100 columns 45 are the mechanism's, of 30 rows 22, less the frame
        self.assertEqual((int(keys["c"]), int(keys["r"])), (43, 19))
        self.assertEqual((int(keys["s"]), int(keys["v"])), (43 * CELL[0], 19 * CELL[1]))
        self.assertIn(b"\033[3;2H\033_Ga=T", terminal.seen)
        self.assertEqual(rows[0][0], surface("paper"))
        colours = {pixel for row in rows for pixel in row}
        self.assertLessEqual(METHOD_COLOURS, colours)
        # a drawing of lines: the most is paper, and the mechanism and its bar of known length take a third of the height
        drawn = [y for y, row in enumerate(rows) if any(pixel != surface("paper") for pixel in row)]
        self.assertGreater(len(drawn), len(rows) / 3)
        self.assertGreater(sum(pixel == surface("paper") for row in rows for pixel in row), 0.7 * len(rows) * len(rows[0]))

    def test_sixels_show_the_pixels_that_kitty_gets(self):
        _, _, wanted = self.kitty_at_the_start()
        terminal = self.open("four-bar", *METHODS, **SIXEL)
        row, column, text = self.at_the_start(terminal)[0]
        self.assertEqual((int(row), int(column)), (3, 2))
        width, height, rows = decode_sixels(text.decode())
        self.assertEqual((width, height), (len(wanted[0]), len(wanted)))
        self.assertFalse(any(pixel is None for line in rows for pixel in line))
        # shades in per cent are right to within 2 of 255, and the colours of this picture fit a palette
        self.assertLessEqual(len({pixel for line in wanted for pixel in line}), 255)
        worst = max(abs(a - b) for line, other in zip(rows, wanted) for p, q in zip(line, other) for a, b in zip(p, q))
        self.assertLessEqual(worst, 2)

    def test_a_window_that_tells_its_size_when_asked_gets_sixels(self):
        terminal = self.open("four-bar", pixels=False, **SIXEL)
        self.assertTrue(terminal.until(terminal.sixels))
        self.assertTrue(terminal.sixels()[0][2].startswith(b'"1;1;430;'))

    def test_other_terminals_get_characters_and_no_string_of_pixels(self):
        for name in (None, b"\033[?1;2c", b"\033[?6c", b"\033[?61;6;22c"):
            terminal = self.open("four-bar", name=name)
            self.assertTrue(terminal.wait_for(BRAILLE), name)
            self.assertTrue(terminal.wait_for(rb"t 1\.\d|\d0 s|1\.\d\d\d"), name)
            self.assertNotIn(b"\033P", terminal.seen)
            # only a terminal of a VT220 or above is asked the third question; who does not answer it gets no more
            strings = re.findall(rb"\033_G[^\033]*", terminal.seen)
            self.assertEqual(strings, [b"\033_Gi=31,s=1,v=1,a=q,t=d,f=24;AAAA"] if name == b"\033[?61;6;22c" else [])
            terminal.type("q")
            self.assertEqual(terminal.ended(), 0)

    def test_off_asks_nothing(self):
        terminal = self.open("four-bar", "--pictures", "off", **KITTY)
        terminal.type("q")
        self.assertEqual(terminal.ended(), 0)
        self.assertNotRegex(terminal.seen, rb"\033\[c|\033\[14t|\033_|\033P")

    def test_colours_are_those_of_the_background_that_the_terminal_says(self):
        def muted(theme):
            # of 6 x 6 x 6 colours, as terminals have them
            red, green, blue = (0 if v < 48 else 1 if v < 115 else (v - 35) // 40 for v in surface("muted", theme))
            return b"38;5;%dm" % (16 + 36 * red + 6 * green + blue)
        self.assertNotEqual(muted("LIGHT"), muted("DARK"))
        for answer, theme in ((b"\033]11;rgb:ffff/ffff/ffff\033\\", "LIGHT"), (b"\033]11;rgb:fd/f6/e3\a", "LIGHT"), (b"\033]11;rgb:0000/2b2b/3636\a", "DARK"),
                              (b"\033]11;nonsense\a", "DARK"), (None, "DARK")):
            for piecemeal in (False, True) if answer and answer.endswith(b"e3\a") else (False,):
                terminal = self.open("four-bar", name=b"\033[?62;c", background=answer, piecemeal=piecemeal)
                self.assertTrue(terminal.until(lambda: b"\033]11;?\a" in terminal.seen and b"\033_G" in terminal.seen))
                terminal.clear()
                terminal.type("?")  # the menu draws everything anew
                self.assertTrue(terminal.wait_for(rb"play or pause"), (answer, piecemeal, terminal.seen[-300:]))
                self.assertTrue(terminal.until(lambda: muted(theme) in terminal.seen), (answer, piecemeal))
        # a theme that is given is not asked for
        terminal = self.open("four-bar", "--theme", "light", name=b"\033[?62;c", background=b"\033]11;rgb:0000/0000/0000\a")
        self.assertTrue(terminal.until(lambda: b"\033_G" in terminal.seen and muted("LIGHT") in terminal.seen))
        self.assertNotIn(b"\033]11", terminal.seen)

    def test_a_picture_has_the_background_of_the_terminal(self):
        for answer, theme in ((b"\033]11;rgb:ffff/ffff/ffff\a", "LIGHT"), (b"\033]11;rgb:1111/1111/1111\a", "DARK")):
            terminal = self.open("four-bar", background=answer, **KITTY)
            self.assertTrue(terminal.until(lambda: any(near(tuple(data[:3]), surface("paper", theme)) or near(tuple(data[:3]), surface("raised", theme))
                                                       for _, data in terminal.images.values())), theme)

    def test_answers_are_no_keys_however_slowly_they_come(self):
        terminal = self.open("four-bar", *METHODS, piecemeal=True, **SIXEL)
        self.assertTrue(terminal.until(terminal.sixels))
        # a 'c' would have switched the picture, a '4' selected nothing, a '2' the second method
        self.assertNotIn(b"characters", terminal.seen)
        terminal.type("i")
        self.assertTrue(terminal.wait_for(rb"why: index-1"))

    def test_an_answer_whose_escape_came_alone_is_no_key(self):
        terminal = self.open("four-bar", *METHODS, parted=0.6, **SIXEL)
        self.assertTrue(terminal.until(terminal.sixels))
        self.assertNotIn(b"characters", terminal.seen)
        terminal.type("i")
        self.assertTrue(terminal.wait_for(rb"why: index-1"))

    def test_the_key_switches_and_lists_take_the_picture_away(self):
        terminal = self.open("four-bar", **KITTY)
        self.assertTrue(terminal.until(lambda: len(terminal.images) == 1))
        terminal.type("?")
        self.assertTrue(terminal.until(lambda: not terminal.images))
        terminal.type("\033")
        self.assertTrue(terminal.until(lambda: len(terminal.images) == 1))
        terminal.clear()
        terminal.type("c")
        self.assertTrue(terminal.until(lambda: not terminal.images))
        self.assertTrue(terminal.wait_for(rb"drawn in characters"))
        self.assertTrue(terminal.wait_for(BRAILLE))
        terminal.type("c")
        self.assertTrue(terminal.until(lambda: len(terminal.images) == 1))
        terminal.type("q")
        self.assertEqual(terminal.ended(), 0)
        self.assertFalse(terminal.images)
        self.assertEqual(termios.tcgetattr(terminal.slave), terminal.modes)

    def test_the_list_of_scenes_shows_each_scene_as_a_picture(self):
        terminal = self.open("four-bar", **SIXEL)
        self.assertTrue(terminal.until(terminal.sixels))
        terminal.clear()
        terminal.type("s")
        self.assertTrue(terminal.wait_for(rb"bennett"))
        self.assertTrue(terminal.until(terminal.sixels))
        first = terminal.sixels()[-1]
        self.assertGreater(int(first[1]), 50)  # to the right of the list
        terminal.clear()
        terminal.type("\033[B")
        self.assertTrue(terminal.until(lambda: terminal.sixels() and terminal.sixels()[-1] != first))

    def test_pictures_that_come_late_are_not_sent_again(self):
        terminal = self.open("four-bar", late=2.0, **SIXEL)
        self.assertTrue(terminal.wait_for(rb"to arrive"))
        terminal.clear()
        terminal.type("\x7f")  # back at the start everything is drawn anew, the motion may have ended
        self.assertTrue(terminal.wait_for(BRAILLE))
        self.assertFalse(terminal.sixels())

    def test_a_signal_takes_the_pictures_away(self):
        terminal = self.open("four-bar", **KITTY)
        self.assertTrue(terminal.until(lambda: len(terminal.images) == 1))
        terminal.process.terminate()
        self.assertEqual(terminal.ended(), -15)
        self.assertFalse(terminal.images)

    def test_a_joint_is_dragged_where_the_picture_has_it(self):
        terminal, _, rows = self.kitty_at_the_start()
        first, second = pivots(rows)
        metre = second[0] - first[0]  # the ground link is 1 m long, the crank 0.5 m
        at_cell = lambda angle: (int((first[0] + 0.5 * metre * math.cos(angle)) / CELL[0]), int((first[1] - 0.5 * metre * math.sin(angle)) / CELL[1]))
        turn = lambda cell: math.atan2(first[1] - (cell[1] + 0.5) * CELL[1], (cell[0] + 0.5) * CELL[0] - first[0])

        # from 1 rad, where it starts, by steps to 1.8 rad; the area begins in column 2 of row 3, the mouse counts from 1
        way = [at_cell(1 + 0.1 * k) for k in range(9)]
        places = ["%d;%d" % (x + 2, y + 3) for x, y in way]
        terminal.clear()
        terminal.type(f"\033[<0;{places[0]}M" + "".join(f"\033[<32;{place}M" for place in places[1:]))
        self.assertTrue(terminal.wait_for(rb"let go: the methods start here"))
        terminal.type(f"\033[<0;{places[-1]}m")
        self.assertTrue(terminal.wait_for(rb"all methods start here now"))
        terminal.clear()
        terminal.type("l")
        self.assertTrue(terminal.wait_for(rb"\033\]52;c;[A-Za-z0-9+/=]+\a"))
        link = base64.b64decode(re.search(rb"\033\]52;c;([A-Za-z0-9+/=]+)\a", terminal.seen).group(1)).decode()
        start = float(re.search(r"set\.start\.th1=([-0-9.e]+)", link).group(1))
        # the pivot is read from the picture to within 2 pixels, of a crank of some 80
        self.assertAlmostEqual(start, turn(way[-1]), delta=2 / (0.5 * metre))


class Words(unittest.TestCase):
    def test_a_word_that_is_none_is_refused(self):
        terminal = Terminal("four-bar", "--pictures", "gif")
        self.addCleanup(terminal.close)
        self.assertEqual(terminal.ended(), 2)
        self.assertRegex(terminal.seen, rb"--pictures is 'gif'; auto, kitty, sixel and off\s+are allowed")


if __name__ == "__main__":
    driver.main()
