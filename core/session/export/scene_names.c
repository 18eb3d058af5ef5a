// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/export/scene_names.h"

#include "dynamics/compile/coordinates.h"
#include "export/spelling.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// An offset below this is rounding [of the coordinate's unit].
static const double NO_OFFSET = 1e-12;

static const char *const HEADING =
    "coordinates of the scene that differ from these ('holonom terms' and programs of your own "
    "use the scene's):";

typedef struct scene_names {
    const hn_exporter *e;
    double *unit, *image; ///< (nv) rates of the system, one at a time, and of the scene
    double *user;         ///< (nv) coordinates of the scene at the start
} scene_names;

static void put_symbol(hn_strbuf *b, const hn_exporter *e, int symbol) {
    hn_code_name(b, e->language, hn_graph_symbol_name(hn_system_graph(e->sys), symbol));
}

/// Returns the share of rate j of the system in the rate of coordinate i of the scene.
static double share_of(const scene_names *s, int i, int j) {
    memset(s->unit, 0, (size_t)s->e->info.nv * sizeof *s->unit);
    s->unit[j] = 1;
    hn_system_rates_to_user(s->e->sys, s->unit, s->image);
    return s->image[i];
}

/// Writes coordinate i of the scene, or its rate, as a sum; what is added comes first.
static void put_sum(hn_strbuf *b, const scene_names *s, int i, bool is_rate) {
    const hn_exporter *e = s->e;
    double sum = 0;
    int n = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (int j = 0; j < e->info.nv; j++) {
            const double share = share_of(s, i, j);
            if (share == 0 || (share < 0) != (pass == 1)) {
                continue;
            }
            const int at = hn_system_position_of(e->sys, j);
            hn_strbuf_add(b, n == 0 ? (pass ? "-" : "") : (pass ? " - " : " + "));
            if (fabs(share) != 1) {
                hn_code_number(b, e->language, fabs(share));
                hn_strbuf_add(b, e->language->times ? e->language->times : "*");
            }
            put_symbol(b, e, is_rate ? e->x.v_symbols[j] : e->x.q_symbols[at]);
            sum += share * e->start.q[at];
            n++;
        }
    }

    // angles of a body may count from another direction than the scene's
    const double offset = s->user[i] - sum;
    if (!is_rate && fabs(offset) > NO_OFFSET) {
        hn_strbuf_add(b, offset < 0 ? " - " : " + ");
        hn_code_number(b, e->language, fabs(offset));
    }
}

/// The only coordinate of the system that is coordinate i of the scene itself; -1: there is none.
static int same_as(const scene_names *s, int i) {
    int found = -1;
    for (int j = 0; j < s->e->info.nv; j++) {
        const double share = share_of(s, i, j);
        if (share != 0 && (found >= 0 || share != 1)) {
            return -1;
        }
        found = share != 0 ? j : found;
    }
    return found;
}

/// Returns whether the scene's name of coordinate i means something else to the program.
static bool is_other(const scene_names *s, int i, const char *name) {
    const int j = same_as(s, i);
    const int at = j < 0 ? -1 : hn_system_position_of(s->e->sys, j);
    const hn_graph *g = hn_system_graph(s->e->sys);
    return at < 0 || strcmp(hn_graph_symbol_name(g, s->e->x.q_symbols[at]), name) != 0;
}

static void put_linear(hn_strbuf *b, const scene_names *s, int i, int indent) {
    const hn_exporter *e = s->e;
    const hn_language *l = e->language;
    const hn_scene *scene = hn_model_scene(e->model);
    const int c = hn_system_user_coordinate(e->sys, i);
    const char *const names[2] = {scene->coordinates[c].name, scene->coordinates[c].rate};
    if (!is_other(s, i, names[0])) {
        return;
    }
    hn_strbuf_printf(b, "%*s", indent, "");
    hn_strbuf_printf(b, "%s", l->named ? "" : l->comment);
    for (int k = 0; k < 2; k++) {
        hn_strbuf name, sum;
        hn_strbuf_init(&name);
        hn_strbuf_init(&sum);
        hn_code_name(&name, l, names[k]);
        hn_strbuf_add(b, l->named && k ? "\n" : "");
        put_sum(&sum, s, i, k == 1);
        hn_code_fill(b,
                     l->named ? l->named
                     : k      ? ", #1 = #2"
                              : " #1 = #2",
                     (const char *[]){hn_strbuf_text(&name), hn_strbuf_text(&sum)});
        b->failed |= name.failed || sum.failed;
        hn_strbuf_reset(&name);
        hn_strbuf_reset(&sum);
    }
    hn_strbuf_printf(b, "%s\n", l->named || !l->comment_end ? "" : l->comment_end);
}

/// Three entries of a rotation vector from i on; `at` is where their quaternion begins in q.
static void put_orientation(hn_strbuf *b, const scene_names *s, int i, int at, int indent) {
    const hn_exporter *e = s->e;
    const hn_scene *scene = hn_model_scene(e->model);
    hn_strbuf words;
    hn_strbuf_init(&words);
    for (int k = 0; k < 3; k++) {
        const int c = hn_system_user_coordinate(e->sys, i + k);
        hn_strbuf_printf(&words, "%s%s", k ? ", " : "", scene->coordinates[c].name);
    }
    hn_strbuf_add(&words, " are the rotation vector of the unit quaternion ");
    for (int k = 0; k < 4; k++) {
        const int symbol = e->x.q_symbols[at + k];
        hn_strbuf_printf(&words, "%s%s", k ? ", " : "",
                         hn_graph_symbol_name(hn_system_graph(e->sys), symbol));
    }
    hn_strbuf_printf(b, "%*s%s ", indent, "", e->language->comment);
    hn_code_words(b, e->language, hn_strbuf_text(&words));
    hn_strbuf_printf(b, "%s\n", e->language->comment_end ? e->language->comment_end : "");
    b->failed |= words.failed;
    hn_strbuf_reset(&words);
}

void hn_export_put_scene_names(hn_strbuf *b, const hn_exporter *e, int indent) {
    const size_t nv = (size_t)e->info.nv;
    scene_names s = {.e = e,
                     .unit = hn_arena_doubles(e->arena, nv),
                     .image = hn_arena_doubles(e->arena, nv),
                     .user = hn_arena_doubles(e->arena, nv)};
    if (!s.unit || !s.image || !s.user) {
        b->failed = 1;
        return;
    }
    hn_system_to_user(e->sys, e->start.q, s.user);

    hn_strbuf lines;
    hn_strbuf_init(&lines);
    int at = 0; // of q
    for (int i = 0; i < e->info.n_user;) {
        if (hn_system_position_of(e->sys, i) >= 0) {
            put_linear(&lines, &s, i, indent);
            i++;
            at++;
        } else {
            put_orientation(&lines, &s, i, at, indent);
            i += 3;
            at += 4;
        }
    }
    if (hn_strbuf_text(&lines)[0]) {
        hn_strbuf_printf(b, "%*s%s ", indent, "", e->language->comment);
        hn_code_words(b, e->language, HEADING);
        hn_strbuf_printf(b, "%s\n%s", e->language->comment_end ? e->language->comment_end : "",
                         hn_strbuf_text(&lines));
    }
    b->failed |= lines.failed;
    hn_strbuf_reset(&lines);
}
