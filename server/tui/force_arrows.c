// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/force_arrows.h"

#include "base/units.h"

#include <math.h>

static const double ROUNDING = 1e-11;   // of the largest force: what is below it is not drawn
static const double SHORTEST = 1.0 / 3; // of the longest arrow, or the scale changes

static double size_of(const double force[3]) {
    return hypot(hypot(force[0], force[1]), force[2]);
}

/// The next 1, 2 or 5 times a power of ten that is not below the value.
static double round_up(double value) {
    const double below = hn_round_125(value);
    return below >= value ? below : hn_round_125(2.5 * below);
}

/// Returns what the longest arrow stands for: as before while that suits.
static double choose_scale(double largest, double before) {
    const bool suits = largest <= before && largest >= SHORTEST * before;
    return suits ? before : round_up(largest);
}

void hn_force_arrows_take(const hn_workbench *w, hn_force_arrows *out) {
    hn_joint_forces *f = w->forces;
    *out = (hn_force_arrows){0};
    if (!w->reactions || !f || f->status != HN_OK || !f->document) {
        return;
    }
    double largest = 0;
    const int n = hn_reaction_writer_count(f->writer);
    for (int i = 0; i < n && out->n < HN_FORCE_ARROWS; i++) {
        hn_snapshot_load *load = &out->load[out->n++];
        *load = (hn_snapshot_load){.point = -1, .unit = "N"};
        hn_reaction_writer_force(f->writer, i, load->force, load->place);
        largest = fmax(largest, size_of(load->force));
    }

    // those that are above rounding
    int kept = 0;
    for (int i = 0; i < out->n; i++) {
        if (size_of(out->load[i].force) > ROUNDING * largest) {
            out->load[kept++] = out->load[i];
        }
    }
    out->n = kept;
    if (largest > 0) {
        f->longest = choose_scale(largest, f->longest);
    }
    out->longest = f->longest;
}
