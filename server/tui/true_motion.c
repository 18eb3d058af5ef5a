// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/true_motion.h"

#include "cli/shell/cache_folder.h"
#include "session/references/reference_doc.h"
#include "session/references/reference_store.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>

enum { MOST_SAMPLES = 1000, FOLDER = 400 };

static double number_of(const cJSON *object, const char *name) {
    const cJSON *item = cJSON_GetObjectItem(object, name);
    return cJSON_IsNumber(item) ? item->valuedouble : 0;
}

/// Copies the points of the document to every stride-th frame; between these nothing is shown.
static bool take_points(hn_true_motion *m, const cJSON *motion, int last, int stride) {
    const cJSON *row, *number;
    const size_t width = 3 * (size_t)m->n_points, n = ((size_t)last + 1) * width;
    m->points = malloc((n + 1) * sizeof *m->points);
    for (size_t k = 0; m->points && k < n; k++) {
        m->points[k] = (double)NAN;
    }
    int frame = 0;
    const cJSON *rows = cJSON_GetObjectItem(motion, "points");
    cJSON_ArrayForEach(row, rows) {
        size_t k = 0;
        if (frame > last || !m->points) {
            break;
        }
        cJSON_ArrayForEach(number, row) {
            if (k < width) {
                m->points[(size_t)frame * width + k++] = number->valuedouble;
            }
        }
        frame += stride;
    }
    m->frames = frame - stride + 1;
    return m->points != NULL;
}

static hn_status read_document(const char *text, const hn_true_motion_request *r, int stride,
                               hn_true_motion **out) {
    cJSON *document = cJSON_Parse(text);
    const cJSON *scales = cJSON_GetObjectItem(document, "scales"),
                *motion = cJSON_GetObjectItem(document, "motion");
    hn_true_motion *m = calloc(1, sizeof *m);
    bool good = document && m;
    if (good) {
        m->n_points = hn_system_get_info(hn_model_system(r->model)).n_points;
        m->own = number_of(motion, "between") * number_of(scales, "length");
        m->digits = number_of(document, "digits");
        m->energy_scale = number_of(scales, "energy");
        good = take_points(m, motion, r->last, stride);
    }
    cJSON_Delete(document);
    if (!good) {
        hn_true_motion_free(m);
        return HN_ERR_MEMORY;
    }
    *out = m;
    return HN_OK;
}

hn_status hn_true_motion_get(const hn_true_motion_request *r, hn_true_motion **out,
                             hn_diags *diags) {
    char folder[FOLDER];
    hn_ref_request request = hn_ref_request_default();
    request.only_stored = !r->compute;
    request.folder = hn_cache_folder_find(folder) ? folder : NULL;
    request.opts.limits = r->limits;
    hn_ref *ref = NULL;
    hn_ref_source source;
    *out = NULL;
    HN_TRY(hn_reference_get(r->model, &request, &ref, &source, diags));

    // its motion at the frames
    const int stride = 1 + r->last / MOST_SAMPLES;
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_status status = hn_reference_motion_json(&text, r->model, ref, source, stride * r->frame_dt,
                                                &r->limits, diags);
    HN_THEN(status, read_document(hn_strbuf_text(&text), r, stride, out));
    hn_strbuf_reset(&text);
    hn_ref_free(ref);
    return status;
}

void hn_true_motion_free(hn_true_motion *m) {
    if (m) {
        free(m->points);
        free(m);
    }
}

const double *hn_true_motion_at(const hn_true_motion *m, int frame) {
    if (!m || m->n_points == 0 || frame >= m->frames) {
        return NULL;
    }
    const double *at = m->points + (size_t)frame * 3 * (size_t)m->n_points;
    return isnan(at[0]) ? NULL : at;
}

double hn_true_motion_error(const hn_true_motion *m, const double *points, int frame) {
    const double *at = hn_true_motion_at(m, frame);
    double most = at ? m->own : (double)NAN;
    for (int p = 0; at && p < m->n_points; p++) {
        const double d = hypot(hypot(points[3 * p] - at[3 * p], points[3 * p + 1] - at[3 * p + 1]),
                               points[3 * p + 2] - at[3 * p + 2]);
        most = d > most || isnan(d) ? d : most;
    }
    return most;
}
