// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/preview.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void forget(hn_preview *p) {
    hn_model_free(p->model);
    free(p->points);
    p->model = NULL;
    p->points = NULL;
}

void hn_preview_load(hn_workbench *w, const char *scene) {
    hn_preview *p = &w->preview;
    if (strcmp(p->scene, scene) == 0) {
        return;
    }
    forget(p);
    snprintf(p->scene, sizeof p->scene, "%s", scene);

    // the drawn points at the assembled start
    const hn_model_source source = {.name = scene};
    hn_diags diags = {0};
    if (!scene[0] || hn_model_load(w->library, &source, &p->model, &diags) != HN_OK) {
        p->model = NULL;
        return;
    }
    const int n = hn_system_get_info(hn_model_system(p->model)).n_points;
    p->points = calloc(3 * (size_t)n + 1, sizeof *p->points);
    if (!p->points || hn_model_points(p->model, hn_model_q(p->model), p->points) != HN_OK) {
        forget(p);
        return;
    }
    hn_model_envelope(p->model, NULL, &p->envelope);
}
