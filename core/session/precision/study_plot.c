// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/precision/study_plot.h"

#include "base/units.h"
#include "render/look.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 900, HEIGHT = 532, LEFT = 66, RIGHT = 190, TOP = 42, BOTTOM = 50, LABEL_STEP = 16 };
static const double MARKER = 4.2; // half its size
static const double SMALLEST = 1e-17;
static const double SLOPE_MARGIN = 0.05; // of the range of costs, left and right

typedef struct frame {
    hn_error_kind error;
    hn_cost_kind cost;
    double x0, x1, y0, y1; ///< powers of ten: costs, errors
} frame;

void hn_plot_begin(hn_strbuf *b, int width, int height, const char *about) {
    hn_strbuf_printf(b, "<svg viewBox=\"0 0 %d %d\" role=\"img\" aria-label=\"%s\">", width, height,
                     about);
}

void hn_plot_text(hn_strbuf *b, double x, double y, const char *class_name, const char *text) {
    hn_strbuf_printf(b, "<text x=\"%.1f\" y=\"%.1f\" class=\"%s\">", x, y, class_name);
    hn_html_text(b, text);
    hn_strbuf_add(b, "</text>");
}

static double floor_of(const hn_wp *wp, hn_error_kind error) {
    return HN_WP_ABOVE_REFERENCE * wp->ref->error[error];
}

static bool is_drawn(const hn_wp_point *p, const frame *f) {
    return p->state == HN_WP_DONE && hn_wp_cost(p, f->cost) > 0 && isfinite(p->worst[f->error]);
}

static double x_of(const frame *f, double cost) {
    const double share = (log10(cost) - f->x0) / (f->x1 - f->x0);
    return LEFT + fmin(1, fmax(0, share)) * (WIDTH - LEFT - RIGHT);
}

static double y_of(const frame *f, double error) {
    const double share = (f->y1 - log10(fmax(error, SMALLEST))) / (f->y1 - f->y0);
    return TOP + fmin(1, fmax(0, share)) * (HEIGHT - TOP - BOTTOM);
}

/// Finds the ranges of the axes: whole decades of the error, the costs with a margin. Returns 0
/// when nothing can be drawn.
static bool find_frame(const hn_wp *wp, frame *f) {
    f->x0 = HUGE_VAL;
    f->x1 = -HUGE_VAL;
    f->y0 = 0;
    f->y1 = -HUGE_VAL;

    // range of the points that can be drawn
    for (int m = 0; m < wp->n_methods; m++) {
        for (int k = 0; k < wp->n_levels; k++) {
            const hn_wp_point *p = &wp->methods[m].point[k];
            if (is_drawn(p, f)) {
                const double e = log10(fmax(p->worst[f->error], SMALLEST));
                f->x0 = fmin(f->x0, log10(hn_wp_cost(p, f->cost)));
                f->x1 = fmax(f->x1, log10(hn_wp_cost(p, f->cost)));
                f->y0 = fmin(f->y0, floor(e));
                f->y1 = fmax(f->y1, ceil(e));
            }
        }
    }

    // room at the sides; errors above 100 are clamped
    const double margin = SLOPE_MARGIN * (f->x1 - f->x0) + 0.05;
    f->x0 -= margin;
    f->x1 += margin;
    f->y1 = fmin(2, f->y1);
    return f->x1 > f->x0 && f->y1 > f->y0;
}

/// Draws the marker of method m. From the ninth method on colours repeat, and a ring is added.
static void put_marker(hn_strbuf *b, int m, double x, double y, double r) {
    static const char *const shapes[HN_MARKER_COUNT] = {
        [HN_MARKER_DISC] = "M-1 0a1 1 0 1 0 2 0a1 1 0 1 0 -2 0Z",
        [HN_MARKER_SQUARE] = "M-.9-.9H.9V.9H-.9Z",
        [HN_MARKER_TRIANGLE] = "M0-1.1L1.1.9H-1.1Z",
        [HN_MARKER_DIAMOND] = "M0-1.25L1.1 0L0 1.25L-1.1 0Z",
        [HN_MARKER_CROSS] = "M-1-1L1 1M1-1L-1 1",
        [HN_MARKER_RING] = "M-1 0a1 1 0 1 0 2 0a1 1 0 1 0 -2 0Z",
        [HN_MARKER_PLUS] = "M-1.1 0H1.1M0-1.1V1.1",
        [HN_MARKER_BOX] = "M-.9-.9H.9V.9H-.9Z",
        [HN_MARKER_DOT] = "M-.5 0a.5.5 0 1 0 1 0a.5.5 0 1 0 -1 0Z",
    };

    // strokes for open shapes, fill for solid ones
    const int slot = hn_look_slot(m);
    const hn_marker marker = hn_look_get(slot)->marker;
    const int open = marker == HN_MARKER_CROSS || marker == HN_MARKER_PLUS ||
                     marker == HN_MARKER_RING || marker == HN_MARKER_BOX;
    hn_strbuf_printf(b,
                     "<path transform=\"translate(%.1f %.1f) scale(%.2f)\" d=\"%s\" "
                     "style=\"%s:var(--slot-%d)\" class=\"%s\"/>",
                     x, y, r, shapes[marker], open ? "stroke" : "fill", slot,
                     open ? "open" : "solid");

    // ring
    if (m >= HN_LOOK_METHODS) {
        hn_strbuf_printf(b,
                         "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" class=\"lap\" "
                         "style=\"stroke:var(--slot-%d)\"/>",
                         x, y, 1.75 * r, slot);
    }
}

/// Writes the class "curve", thinner where colours repeat, and the dashes.
static void put_line_style(hn_strbuf *b, int m, const char *more) {
    const hn_look *look = hn_look_get(hn_look_slot(m));
    hn_strbuf_printf(b, " class=\"curve%s%s\" style=\"stroke:var(--slot-%d)\"",
                     m >= HN_LOOK_METHODS ? " again" : "", more, hn_look_slot(m));
    for (int i = 0; i < look->n_dash; i++) {
        hn_strbuf_printf(b, "%s%g", i ? " " : " stroke-dasharray=\"", look->dash[i]);
    }
    hn_strbuf_add(b, look->n_dash ? "\"/>" : "/>");
}

void hn_study_key(hn_strbuf *b, int m) {
    hn_strbuf_add(b, "<svg class=\"key\" viewBox=\"-14 -8 28 16\" width=\"28\" height=\"16\" "
                     "aria-hidden=\"true\"><path d=\"M-14 0H14\"");
    put_line_style(b, m, "");
    put_marker(b, m, 0, 0, MARKER);
    hn_strbuf_add(b, "</svg>");
}

static void put_error_axis(hn_strbuf *b, const frame *f) {
    const int every = f->y1 - f->y0 > 9 ? 2 : 1;
    for (int d = (int)f->y0; d <= (int)f->y1; d++) {
        const double y = y_of(f, pow(10, d));
        if ((d - (int)f->y0) % every == 0) {
            hn_strbuf_printf(b, "<path class=\"grid\" d=\"M%d %.1fH%d\"/>", LEFT, y, WIDTH - RIGHT);
            hn_strbuf_printf(b,
                             "<text x=\"%d\" y=\"%.1f\" class=\"tick end\">10<tspan dy=\"-5\" "
                             "class=\"power\">%d</tspan></text>",
                             LEFT - 8, y + 4, d);
        }
    }
}

static void put_cost_axis(hn_strbuf *b, const frame *f) {
    static const char *const titles[HN_COST_COUNT] = {"CPU time of one run, median [s]",
                                                      "arithmetic operations of one run",
                                                      "evaluations of the dynamics in one run"};
    for (int d = (int)ceil(f->x0); d <= (int)floor(f->x1); d++) {
        char text[HN_SI_TEXT];
        const double x = x_of(f, pow(10, d));
        hn_si_format(pow(10, d), f->cost == HN_COST_TIME ? "s" : "op", 1, text);
        hn_strbuf_printf(b, "<path class=\"grid\" d=\"M%.1f %dV%d\"/>", x, TOP, HEIGHT - BOTTOM);
        if (f->cost == HN_COST_EVALS) {
            snprintf(text, sizeof text, "%.0f", pow(10, d));
        }
        hn_plot_text(b, x, HEIGHT - BOTTOM + 18, "tick middle", text);
    }
    hn_plot_text(b, LEFT + (WIDTH - LEFT - RIGHT) / 2.0, HEIGHT - 10, "title middle",
                 titles[f->cost]);
}

/// Draws the band of errors that the reference cannot resolve.
static void put_band(hn_strbuf *b, const hn_wp *wp, const frame *f) {
    const double floor = floor_of(wp, f->error);
    if (floor > 0 && log10(floor) > f->y0) {
        const double y = y_of(f, floor);
        hn_strbuf_printf(b,
                         "<rect class=\"band\" x=\"%d\" y=\"%.1f\" width=\"%d\" height=\"%.1f\"/>",
                         LEFT, y, WIDTH - LEFT - RIGHT, HEIGHT - BOTTOM - y);
        hn_plot_text(b, LEFT + 6, HEIGHT - BOTTOM - 6, "note",
                     "not resolved by the reference solution");
    }
}

static void put_tip(hn_strbuf *b, const hn_study *s, const frame *f, int m, int k) {
    const hn_wp *wp = hn_study_wp(s);
    const hn_wp_point *p = &wp->methods[m].point[k];
    char spelling[HN_SPEC_MAX], time[HN_SI_TEXT];
    hn_wp_spelling(wp, m, k, spelling);
    hn_si_format(p->median, "s", 3, time);
    hn_strbuf_add(b, "<title>");
    hn_html_text(b, spelling);
    if (p->state == HN_WP_DONE) {
        hn_strbuf_printf(b, "\nerror %.2e, ", p->worst[f->error]);
        hn_html_text(b, isfinite(p->median) ? time : "not timed");
        hn_strbuf_printf(b, ", %lld steps, %lld evaluations", p->steps, p->cost.evals);
    } else {
        hn_strbuf_printf(b, "\nended at t = %.4g s: ", p->t_reached);
        hn_html_text(b, p->reason);
    }
    hn_strbuf_add(b, "</title>");
}

static void put_curve(hn_strbuf *b, const hn_study *s, const frame *f, int m) {
    const hn_wp *wp = hn_study_wp(s);
    int started = 0;
    hn_strbuf_add(b, "<path d=\"");

    // line through the points
    for (int k = 0; k < wp->n_levels; k++) {
        const hn_wp_point *p = &wp->methods[m].point[k];
        if (is_drawn(p, f)) {
            hn_strbuf_printf(b, "%s%.1f %.1f", started ? "L" : "M", x_of(f, hn_wp_cost(p, f->cost)),
                             y_of(f, p->worst[f->error]));
            started = 1;
        }
    }
    hn_strbuf_add(b, "\"");
    put_line_style(b, m, hn_study_classes(s)[m].kind == HN_CLASS_ELSEWHERE ? " elsewhere" : "");

    // markers with tooltips on top
    for (int k = 0; k < wp->n_levels; k++) {
        const hn_wp_point *p = &wp->methods[m].point[k];
        if (is_drawn(p, f)) {
            hn_strbuf_add(b, "<g class=\"point\">");
            put_tip(b, s, f, m, k);
            put_marker(b, m, x_of(f, hn_wp_cost(p, f->cost)), y_of(f, p->worst[f->error]), MARKER);
            hn_strbuf_add(b, "</g>");
        }
    }
}

/// Returns the cost of a failed run until its end: its counts, or the CPU time of that run.
static double cost_until_failure(const hn_wp_point *p, hn_cost_kind cost) {
    return cost == HN_COST_TIME ? p->first_cpu : hn_wp_cost(p, cost);
}

static void put_failures(hn_strbuf *b, const hn_study *s, const frame *f, int m) {
    const hn_wp *wp = hn_study_wp(s);
    for (int k = 0; k < wp->n_levels; k++) {
        const hn_wp_point *p = &wp->methods[m].point[k];
        if (p->state == HN_WP_FAILED) {
            const double cost = cost_until_failure(p, f->cost);
            const double x = cost > 0 ? x_of(f, cost) : LEFT;
            hn_strbuf_add(b, "<g class=\"failed\">");
            put_tip(b, s, f, m, k);
            hn_strbuf_printf(b,
                             "<path transform=\"translate(%.1f %d)\" d=\"M-5-5L5 5M5-5L-5 5\" "
                             "style=\"stroke:var(--slot-%d)\"/></g>",
                             x, TOP - 8, hn_look_slot(m));
        }
    }
}

// labels at the curves' ends ----

typedef struct label {
    int method;
    double x, y, at; ///< end of the curve, and where the label is put
} label;

static int collect_labels(const hn_wp *wp, const frame *f, label *list) {
    int n = 0;
    for (int m = 0; m < wp->n_methods; m++) {
        for (int k = wp->n_levels - 1; k >= 0; k--) {
            const hn_wp_point *p = &wp->methods[m].point[k];
            if (is_drawn(p, f)) {
                const double y = y_of(f, p->worst[f->error]);
                int i = n++;
                for (; i > 0 && list[i - 1].y > y; i--) {
                    list[i] = list[i - 1];
                }
                list[i] = (label){m, x_of(f, hn_wp_cost(p, f->cost)), y, y};
                break;
            }
        }
    }
    return n;
}

/// Moves labels apart downwards, then up again from the lower edge.
static void spread_labels(label *list, int n) {
    for (int i = 1; i < n; i++) {
        list[i].at = fmax(list[i].at, list[i - 1].at + LABEL_STEP);
    }
    double lowest = HEIGHT - BOTTOM;
    for (int i = n - 1; i >= 0; i--) {
        list[i].at = fmin(list[i].at, lowest);
        lowest = list[i].at - LABEL_STEP;
    }
}

static void put_labels(hn_strbuf *b, const hn_wp *wp, const frame *f) {
    label list[HN_WP_METHODS];
    const int n = collect_labels(wp, f, list);
    spread_labels(list, n);
    for (int i = 0; i < n; i++) {
        const double edge = WIDTH - RIGHT;
        hn_strbuf_printf(b, "<g class=\"entry\" data-m=\"%d\">", list[i].method);
        hn_strbuf_printf(b, "<path class=\"leader\" d=\"M%.1f %.1fL%.1f %.1fH%.1f\"/>",
                         list[i].x + MARKER + 2, list[i].y, edge + 2, list[i].at, edge + 8);
        put_marker(b, list[i].method, edge + 15, list[i].at, MARKER);
        hn_plot_text(b, edge + 24, list[i].at + 4, "label", wp->methods[list[i].method].spelling);
        hn_strbuf_add(b, "</g>");
    }
}

void hn_study_plot(hn_strbuf *b, const hn_study *s, hn_error_kind error, hn_cost_kind cost) {
    const hn_wp *wp = hn_study_wp(s);
    frame f = {.error = error, .cost = cost};
    char title[120];
    if (!find_frame(wp, &f)) {
        hn_strbuf_add(b, "<p class=\"none\">There is no point to draw: no run reached its end, or "
                         "no time was measured.</p>");
        return;
    }

    // accessible name
    snprintf(title, sizeof title, "error of the %s, largest over the run", hn_error_title(error));
    hn_strbuf_printf(b, "<svg viewBox=\"0 0 %d %d\" role=\"img\" aria-label=\"%s against %s\">",
                     WIDTH, HEIGHT, title, hn_cost_name(cost));

    // axes and what lies behind the curves
    put_error_axis(b, &f);
    put_cost_axis(b, &f);
    put_band(b, wp, &f);
    hn_strbuf_printf(b, "<path class=\"axis\" d=\"M%d %dV%dH%d\"/>", LEFT, TOP, HEIGHT - BOTTOM,
                     WIDTH - RIGHT);
    hn_plot_text(b, 6, 14, "title", title);

    // curves, then their labels
    for (int m = 0; m < wp->n_methods; m++) {
        hn_strbuf_printf(b, "<g class=\"series\" data-m=\"%d\">", m);
        put_curve(b, s, &f, m);
        put_failures(b, s, &f, m);
        hn_strbuf_add(b, "</g>");
    }
    put_labels(b, wp, &f);
    hn_strbuf_add(b, "</svg>");
}
