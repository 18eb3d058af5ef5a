// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/live/pulls.h"

#include "session/job/field.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ENTRY_NUMBERS = 7 };

hn_pull hn_pull_read(const cJSON *object) {
    hn_pull pull = {.point = (int)hn_fields_number(object, "point", 0),
                    .stiffness = hn_fields_number(object, "stiffness", -1),
                    .damping = hn_fields_number(object, "damping", -1)};
    int i = 0;
    const cJSON *item;
    cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(object, "to")) {
        pull.to[i++] = item->valuedouble; // the field table allows no more than three
    }
    return pull;
}

void hn_pull_list_reset(hn_pull_list *list) {
    free(list->at);
    *list = (hn_pull_list){0};
}

/// Reads one entry; false where it is at fault.
static bool read_entry(const cJSON *entry, hn_pull_event *out) {
    double x[ENTRY_NUMBERS];
    int n = 0;
    const cJSON *item;
    cJSON_ArrayForEach(item, entry) {
        if (n == ENTRY_NUMBERS || !cJSON_IsNumber(item) || !isfinite(item->valuedouble)) {
            return false;
        }
        x[n++] = item->valuedouble;
    }
    const bool whole = n == ENTRY_NUMBERS && x[0] == floor(x[0]) && x[1] == floor(x[1]);
    if (!whole || x[0] < 0 || x[0] > 1e12 || x[1] < 0 || x[1] > 1e6 || x[5] < 0 || x[6] < 0) {
        return false;
    }
    *out = (hn_pull_event){
        .frame = (long long)x[0],
        .pull = {.point = (int)x[1], .to = {x[2], x[3], x[4]}, .stiffness = x[5], .damping = x[6]}};
    return true;
}

hn_status hn_pull_list_read(const cJSON *array, hn_pull_list *list, hn_diags *diags) {
    *list = (hn_pull_list){0};
    if (array && !cJSON_IsArray(array)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/pulls", NULL, "expected a list of pulls");
    }
    const int n = cJSON_GetArraySize(array);
    if (n > HN_PULL_MOST_ENTRIES) {
        return hn_diags_add(diags, HN_ERR_LIMIT, "/pulls", NULL,
                            "%d pulls were given, at most %d are allowed", n, HN_PULL_MOST_ENTRIES);
    }
    list->at = calloc((size_t)n + 1, sizeof *list->at);
    if (!list->at) {
        return HN_ERR_MEMORY;
    }

    const cJSON *entry;
    cJSON_ArrayForEach(entry, array) {
        hn_pull_event *e = &list->at[list->n];
        if (!read_entry(entry, e) || (list->n > 0 && e->frame < e[-1].frame)) {
            char pointer[32];
            snprintf(pointer, sizeof pointer, "/pulls/%d", list->n);
            hn_pull_list_reset(list);
            return hn_diags_add(diags, HN_ERR_INPUT, pointer,
                                "as in [120, 2, 1.3, 0.7, 0, 400, 30], in order of frames",
                                "expected [frame, point, x, y, z, stiffness, damping]");
        }
        list->n++;
    }
    return HN_OK;
}

hn_status hn_pull_list_copy(const hn_comparison *from, double frame_dt, hn_pull_list *list) {
    const hn_pull_event *events;
    const int n = hn_comparison_pulls(from, &events);
    const double scale = hn_comparison_frame_dt(from) / frame_dt;
    *list = (hn_pull_list){.at = calloc((size_t)n + 1, sizeof *list->at), .n = n};
    if (!list->at) {
        list->n = 0;
        return HN_ERR_MEMORY;
    }
    for (int i = 0; i < n; i++) {
        list->at[i] = events[i];
        list->at[i].frame = llround((double)events[i].frame * scale);
    }
    return HN_OK;
}

hn_status hn_pull_list_name_points(const hn_pull_list *list, hn_scene_request *scene,
                                   hn_diags *diags) {
    scene->n_pulls = 0;
    for (int i = 0; i < list->n; i++) {
        HN_TRY(hn_scene_request_add_pull(scene, list->at[i].pull.point, diags));
    }
    return HN_OK;
}

hn_status hn_pull_list_give(const hn_pull_list *list, hn_comparison *c, hn_diags *diags) {
    hn_diag diag = {0};
    const hn_status status = hn_comparison_set_pulls(c, list->at, list->n, &diag);
    return status == HN_OK
               ? HN_OK
               : hn_diags_add(diags, status, diag.pointer, diag.hint, "%s", diag.message);
}

void hn_pulls_json(hn_strbuf *b, const hn_comparison *c, int first) {
    const hn_pull_event *events;
    const int n = hn_comparison_pulls(c, &events);
    for (int i = first; i < n; i++) {
        hn_strbuf entry;
        hn_strbuf_init(&entry);
        hn_pull_event_json(&entry, &events[i]);
        hn_strbuf_printf(b, "%s%s", i > 0 ? "," : "", hn_strbuf_text(&entry));
        b->failed |= entry.failed;
        hn_strbuf_reset(&entry);
    }
}
