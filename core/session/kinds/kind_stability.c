// SPDX-License-Identifier: GPL-3.0-or-later
// Stability map: where steps are stable, predicted from the spectrum and tried.
#include "session/kinds/job.h"
#include "session/stability/stability.h"
#include "session/stability/stability_axes.h"
#include "session/stability/stability_doc.h"
#include "session/stability/stability_html.h"
#include "session/stability/stability_picture.h"

static const char *const PRESETS[] = {
#define NAME(maker, name, about, chooses, stabilised, units) name,
    HN_MAP_PRESETS(NAME)
#undef NAME
        NULL};

static const hn_field FIELDS[] = {
    HN_JOB_METHODS_FIELD(HN_MAP_METHODS, 4),
    HN_JOB_TIME_FIELD,
    HN_JOB_TIME_LIMIT_FIELD("60 when left out, 0: none"),
    {.name = "preset",
     .type = HN_FIELD_CHOICE,
     .choices = PRESETS,
     .argument = "NAME",
     .about = "axes of the map by name; when left out: limits, and for a mechanism with loops that "
              "turns out not to be stiff, the error over alpha and beta"},
    {.name = "over",
     .type = HN_FIELD_TEXT,
     .argument = "AXES",
     .about =
         "one or two axes in place of a preset, as in h=1e-4..1e-1,k=1e2..1e8; :lin or :log after "
         "an axis chooses its spacing; 'step' names the step in a scene where h is a parameter"},
    {.name = "columns",
     .type = HN_FIELD_INTEGER,
     .min = 2,
     .max = HN_MAP_SIDE,
     .served_max = 24,
     .about = "columns of the map; 24 when left out"},
    {.name = "rows",
     .type = HN_FIELD_INTEGER,
     .min = 2,
     .max = HN_MAP_SIDE,
     .served_max = 24,
     .about = "rows of the map; 24 when left out"},
    HN_JOB_END_OF_FIELDS,
};

static hn_status open_map(const hn_job_request *request, void **work, hn_diags *diags) {
    return hn_map_open(request, (hn_map **)work, diags);
}

static int resumed(const void *work) {
    return hn_map_resumed(work);
}

static hn_status run(void *work, const hn_job_request *request, hn_job_end *end, hn_diags *diags) {
    (void)request, (void)diags;
    hn_map_run(work);
    end->stopped = hn_map_stopped(work);
    end->out_of_time = hn_map_out_of_time(work);
    end->lost = hn_map_lost(work);
    return HN_OK;
}

static void set_time_limit(void *work, double time_limit) {
    hn_map_set_time_limit(work, time_limit);
}

static void release(void *work) {
    hn_map_free(work);
}

static void write_png(hn_strbuf *b, const hn_map *map) {
    hn_diag diag = {0};
    b->failed |= hn_map_png(b, map, &diag) != HN_OK;
}

HN_JOB_FORM(html, hn_map, hn_map_html)
HN_JOB_FORM(json, hn_map, hn_map_json)
HN_JOB_FORM(csv, hn_map, hn_map_csv)
HN_JOB_FORM(svg, hn_map, hn_map_svg)
HN_JOB_FORM(png, hn_map, write_png)

const hn_job_kind hn_kind_stability = {
    .name = "stability",
    .title = "where steps are stable",
    .about = "which steps are stable: the limit predicted from the spectrum, and the limit found "
             "by trials",
    .command = "study",
    .words = HN_JOB_WORDS_SCENE,
    .pieces = "cells",
    .chooses = "h",
    .served = true,
    .fields = FIELDS,
    .preset = hn_map_preset_at,
    .forms = {{".html", put_html},
              {".json", put_json},
              {".csv", put_csv},
              {".svg", put_svg},
              {".png", put_png}},
    .open = open_map,
    .resumed = resumed,
    .run = run,
    .set_time_limit = set_time_limit,
    .release = release,
};
