// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/figures_sets.h"

#include "support/near.h"

#include <math.h>
#include <stdio.h>

// Scenes that figures are measured on and no lesson ships.

const char hn_figure_bob[] =
    "{\"holonom\": 1, \"name\": \"bob\", \"lagrangian\": {\"coordinates\": ["
    "{\"name\": \"x\", \"rate\": \"vx\", \"unit\": \"m\"}, {\"name\": \"y\", \"rate\": \"vy\", "
    "\"unit\": \"m\"}], \"kinetic\": \"(vx^2 + vy^2)/2\", \"potential\": \"9.81*y\","
    "\"constraints\": [{\"name\": \"rod\", \"formula\": \"(x^2 + y^2 - 1)/2\"}]},"
    "\"start\": {\"positions\": {\"x\": 1, \"y\": {\"guess\": 0}}, \"rates\": {\"vy\": 0}}}";

hn_figure_links hn_figure_fb0(void) {
    return (hn_figure_links){.l1 = 1,
                             .l2 = 2,
                             .l3 = 1.8,
                             .d = 2.2,
                             .m1 = 1,
                             .m2 = 2,
                             .m3 = 1.8,
                             .g = 9.81,
                             .th1 = 1,
                             .w1 = 2,
                             .th2 = 0.5,
                             .th3 = 1.5};
}

/// The start as JSON: the crank given and the rest guessed, or all of it given.
static void put_start(const hn_figure_links *l, char *text, size_t size) {
    if (l->pinned) {
        (void)snprintf(text, size,
                       "{\"positions\": {\"th1\": %.17g, \"th2\": %.17g, \"th3\": %.17g}, "
                       "\"rates\": {\"th1\": %.17g, \"th2\": %.17g, \"th3\": %.17g}}",
                       l->th1, l->th2, l->th3, l->w1, l->w2, l->w3);
        return;
    }
    (void)snprintf(text, size,
                   "{\"positions\": {\"th1\": %.17g, \"th2\": {\"guess\": %.17g}, \"th3\": "
                   "{\"guess\": %.17g}}, \"rates\": {\"th1\": %.17g}}",
                   l->th1, l->th2, l->th3, l->w1);
}

void hn_figure_open_links(hn_model *m, const hn_figure_links *l) {
    char text[2000], start[400];
    put_start(l, start, sizeof start);
    const int length = snprintf(
        text, sizeof text,
        "{\"holonom\": 1, \"name\": \"links\", \"lagrangian\": {\"coordinates\": ["
        "{\"name\": \"th1\", \"rate\": \"w1\", \"unit\": \"rad\", \"actuated\": %s}, "
        "{\"name\": \"th2\", \"rate\": \"w2\", \"unit\": \"rad\", \"actuated\": %s}, "
        "{\"name\": \"th3\", \"rate\": \"w3\", \"unit\": \"rad\"}],"
        "\"kinetic\": \"%.17g*w1^2/2 + %.17g*w2^2/2 + %.17g*w3^2/2 + %.17g*cos(th1 - th2)*w1*w2\","
        "\"potential\": \"%.17g*sin(th1) + %.17g*sin(th2) + %.17g*sin(th3)\","
        "\"constraints\": [{\"name\": \"x\", \"formula\": "
        "\"%.17g*cos(th1) + %.17g*cos(th2) - %.17g*cos(th3) - %.17g\"}, {\"name\": \"y\", "
        "\"formula\": \"%.17g*sin(th1) + %.17g*sin(th2) - %.17g*sin(th3)\"}]},"
        "\"start\": %s}",
        l->coupler_drives ? "false" : "true", l->coupler_drives ? "true" : "false",
        (l->m1 / 3 + l->m2) * l->l1 * l->l1, l->m2 * l->l2 * l->l2 / 3, l->m3 * l->l3 * l->l3 / 3,
        l->m2 * l->l1 * l->l2 / 2, l->g * (l->m1 / 2 + l->m2) * l->l1, l->g * l->m2 / 2 * l->l2,
        l->g * l->m3 / 2 * l->l3, l->l1, l->l2, l->l3, l->d, l->l1, l->l2, l->l3, start);
    assert_true(length > 0 && (size_t)length < sizeof text);
    hn_model_open_text(m, text, NULL);
}

// ---- a chain of point masses on massless rods ----

typedef struct writer {
    char text[6000], *p;
} writer;

#define PUT(w, ...)                                                         \
    do {                                                                    \
        const size_t left = sizeof(w)->text - (size_t)((w)->p - (w)->text); \
        const int length = snprintf((w)->p, left, __VA_ARGS__);             \
        assert_true(length >= 0 && (size_t)length < left);                  \
        (w)->p += length;                                                   \
    } while (0)

enum { RODS = 10 };

void hn_figure_open_chain(hn_model *m, double tip) {
    writer w;
    double x = 0, y = 0;
    w.p = w.text;
    PUT(&w, "{\"holonom\": 1, \"name\": \"chain\", \"lagrangian\": {\"coordinates\": [");
    for (int i = 0; i < RODS; i++) {
        PUT(&w, "%s{\"name\": \"x%d\", \"rate\": \"u%d\", \"unit\": \"m\"}, ", i ? ", " : "", i, i);
        PUT(&w, "{\"name\": \"y%d\", \"rate\": \"v%d\", \"unit\": \"m\"}", i, i);
    }
    PUT(&w, "], \"kinetic\": \"(0");
    for (int i = 0; i < RODS; i++) {
        PUT(&w, " + %.17g*(u%d^2 + v%d^2)", i == RODS - 1 ? tip : 1.0, i, i);
    }
    PUT(&w, ")/2\", \"potential\": \"9.81*(0");
    for (int i = 0; i < RODS; i++) {
        PUT(&w, " + %.17g*y%d", i == RODS - 1 ? tip : 1.0, i);
    }
    PUT(&w, ")\", \"constraints\": [{\"name\": \"r0\", \"formula\": \"(x0^2 + y0^2 - 1)/2\"}");
    for (int i = 1; i < RODS; i++) {
        PUT(&w, ", {\"name\": \"r%d\", \"formula\": ", i);
        PUT(&w, "\"((x%d - x%d)^2 + (y%d - y%d)^2 - 1)/2\"}", i, i - 1, i, i - 1);
    }
    PUT(&w, "]}, \"start\": {\"positions\": {");
    for (int i = 0; i < RODS; i++) {
        x += cos(0.3 * i);
        y -= sin(0.3 * i);
        PUT(&w, "%s\"x%d\": {\"guess\": %.17g}, ", i ? ", " : "", i, x);
        PUT(&w, "\"y%d\": {\"guess\": %.17g}", i, y);
    }
    PUT(&w, "}, \"rates\": {}}}");
    hn_model_open_text(m, w.text, NULL);
    assert_int_equal(m->status, HN_OK);
}
