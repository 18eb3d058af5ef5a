// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/study/reference_text.h"

#include "cli/shell/table.h"
#include "session/references/reference_store.h"

#include <math.h>

enum { MOST_COORDINATES = 6, ROWS = 9 };

static void put_values(hn_strbuf *b, const hn_model *model, const hn_ref *ref) {
    const hn_system *sys = hn_model_system(model);
    const hn_scene *scene = hn_model_scene(model);
    const int shown = ref->n_user < MOST_COORDINATES ? ref->n_user : MOST_COORDINATES;

    // columns: time, digits, and the first coordinates
    hn_table t;
    hn_table_init(&t);
    hn_table_column(&t, "t [s]", 1);
    hn_table_column(&t, "digits", 1);
    for (int i = 0; i < shown; i++) {
        hn_table_column(&t, scene->coordinates[hn_system_user_coordinate(sys, i)].name, 1);
    }

    // a few samples, evenly spread over the time
    for (int r = 0; r < ROWS; r++) {
        const int k = r * ref->n / (ROWS - 1);
        const hn_state_seen at = hn_ref_at(ref, k);
        const double e = ref->between[(size_t)k * HN_ERROR_COUNT + HN_ERROR_Q];
        hn_table_cell(&t, "%.6g", at.t);
        hn_table_cell(&t, "%.1f", fmin(16, -log10(e)));
        for (int i = 0; i < shown; i++) {
            hn_table_cell(&t, "%.15g", at.q[i]);
        }
    }

    hn_table_write(b, &t);
    hn_table_reset(&t);

    // say what the table leaves out
    if (shown < ref->n_user) {
        hn_strbuf_printf(
            b, "--json shows %d more coordinates, all rates, multipliers and the energy\n",
            ref->n_user - shown);
    }
}

void hn_reference_text(hn_strbuf *b, const hn_reference_work *work) {
    const hn_ref *ref = work->ref;
    const hn_ref_source source = work->source;
    const hn_scene *scene = hn_model_scene(work->model);

    // what it is the reference of
    hn_strbuf_printf(b, "%s, to t = %g s (%s)\n", scene->title ? scene->title : scene->id, ref->T,
                     hn_ref_source_name(source));

    // the shipped reference ends early where the motion is chaotic
    if (ref->T < scene->duration && source == HN_REF_SHIPPED) {
        hn_strbuf_printf(b,
                         "The scene's own time is %g s. The shipped reference ends earlier, where "
                         "fewer than %d digits are sure, because the motion is chaotic.\n",
                         scene->duration, HN_HOLD_DIGITS);
    }

    // the two methods and how well they agree
    hn_strbuf_printf(
        b,
        "1: %s\n2: %s\nThey have only the equations in common, and agree to %.1f digits of the "
        "coordinates, to %.1e of the rates, %.1e of the reactions and %.1e of the energy.\n",
        ref->means[0], ref->means[1], hn_ref_digits(ref), ref->error[HN_ERROR_V],
        ref->error[HN_ERROR_REACTION], ref->error[HN_ERROR_ENERGY]);

    // a method that failed, and why
    if (ref->refused[0]) {
        hn_strbuf_printf(b, "Did not reach the end: %s\n", ref->refused);
    }

    hn_strbuf_add(b, "\n");
    put_values(b, work->model, ref);
}
