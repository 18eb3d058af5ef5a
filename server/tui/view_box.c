// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/view_box.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double FOLLOWED = 0.5; // of the envelope's larger side, beyond it
/// Share of the same, on each side: widening takes so much more, so that the view does not change
/// with every frame.
static const double STEP = 0.05;
/// Share of the same: less than that beyond the view is within the margin of its drawing.
static const double MARGIN = 0.005;

void hn_view_box_begin(hn_workbench *w) {
    hn_view_box *own = &w->view_box;
    if (!own->is_drawn) {
        const int n = hn_system_get_info(hn_model_system(w->model)).n_points;
        memcpy(own->envelope, w->envelope.box, sizeof own->envelope);
        own->is_drawn = malloc((size_t)n + 1);
        if (own->is_drawn) {
            hn_model_drawn_points(w->model, own->is_drawn);
        }
    }
    memcpy(w->envelope.box, own->envelope, sizeof own->envelope);
    own->frames = 0;
}

void hn_view_box_free(hn_workbench *w) {
    free(w->view_box.is_drawn);
    w->view_box.is_drawn = NULL;
}

/// Widens the view by a point, as far as it is followed.
static void widen(hn_workbench *w, double size, const double point[3]) {
    const double *envelope = w->view_box.envelope;
    double *box = w->envelope.box, seen[2];
    hn_view_project(&w->envelope.look, point, seen);
    for (int k = 0; k < 2; k++) {
        const double low = envelope[k] - FOLLOWED * size, high = envelope[2 + k] + FOLLOWED * size;
        if (seen[k] < box[k] - MARGIN * size && seen[k] >= low) {
            box[k] = seen[k] - STEP * size;
        } else if (seen[k] > box[2 + k] + MARGIN * size && seen[k] <= high) {
            box[2 + k] = seen[k] + STEP * size;
        }
    }
}

void hn_view_box_update(hn_workbench *w) {
    hn_view_box *own = &w->view_box;
    const int n = hn_system_get_info(hn_model_system(w->model)).n_points;
    const double *box = own->envelope;
    const double size = fmax(box[2] - box[0], box[3] - box[1]);
    const int frames = hn_recording_frames(w->recording);

    // NaN, of a method that ended before its first frame, is beyond nothing
    for (; own->is_drawn && own->frames < frames; own->frames++) {
        for (int m = 0; m < w->n_methods; m++) {
            const double *points =
                hn_recording_track(w->recording, m)->points + (size_t)own->frames * 3 * (size_t)n;
            for (int i = 0; i < n; i++) {
                if (own->is_drawn[i]) {
                    widen(w, size, points + 3 * (size_t)i);
                }
            }
        }
    }
}
