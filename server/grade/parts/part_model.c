// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/part_model.h"

#include "base/suggest.h"

#include <stdio.h>
#include <string.h>

enum { MAX_COORDINATES = 256, STEPS_AT_ONCE = 16 };
/// The last steps are those of hn_run_advance(), which knows where a run is to end.
static const double NEARLY = 0.99;

static const cJSON *set_of(const hn_part *p) {
    return cJSON_GetObjectItemCaseSensitive(p->node, "set");
}

hn_status hn_part_settings(const hn_part *p, hn_setting settings[HN_PART_SETTINGS], int *n,
                           hn_diag *diag) {
    const cJSON *m;
    *n = 0;
    cJSON_ArrayForEach(m, set_of(p)) {
        const char *formula = cJSON_GetStringValue(m), *name = m->string ? m->string : formula;
        if (!formula || *n == HN_PART_SETTINGS) {
            return hn_diag_set(diag, HN_ERR_INPUT, "/parts/set", NULL,
                               "part %s: \"set\" takes at most %d names, or formulas under names",
                               p->id, HN_PART_SETTINGS);
        }
        settings[*n].name = name;
        HN_TRY(hn_draw_value(p->draw, formula, &settings[*n].value, diag));
        ++*n;
    }
    return HN_OK;
}

hn_status hn_part_load_model(const hn_part *p, hn_model **model, hn_diag *diag) {
    hn_setting settings[HN_PART_SETTINGS];
    hn_diags diags = {0};
    int n;
    HN_TRY(hn_part_settings(p, settings, &n, diag));
    if (!p->lib) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/parts/scene", NULL, "no library of scenes here");
    }

    // the first message of the loader becomes that of the part
    const hn_model_source source = {.name = hn_part_text(p->node, "scene"),
                                    .settings = settings,
                                    .n_settings = n,
                                    .interrupt = p->interrupt};
    const hn_status status = hn_model_load(p->lib, &source, model, &diags);
    return status == HN_OK ? status
                           : hn_diag_set(diag, status == HN_ERR_MEMORY ? status : HN_ERR_INPUT,
                                         "/parts/scene", NULL, "%.300s", diags.item[0].message);
}

hn_status hn_part_advance(const hn_part *p, hn_run *run, double t) {
    for (int i = 0; hn_run_time(run) < NEARLY * t; i++) {
        if (i % STEPS_AT_ONCE == 0 && hn_interrupt_ask(&p->interrupt)) {
            return HN_ERR_STOPPED;
        }
        HN_TRY(hn_run_step_towards(run, t));
    }
    return hn_run_advance(run, t);
}

void hn_part_put_settings(hn_strbuf *b, const hn_part *p) {
    hn_setting settings[HN_PART_SETTINGS];
    int n;
    if (hn_part_settings(p, settings, &n, NULL) != HN_OK) {
        return;
    }
    for (int i = 0; i < n; i++) {
        hn_strbuf_printf(b, "%s%s=%g", i ? " --set " : " with --set ", settings[i].name,
                         settings[i].value);
    }
}

const hn_coordinate *hn_part_coordinate(const hn_model *model, int i) {
    return &hn_model_scene(model)
                ->coordinates[hn_system_user_coordinate(hn_model_system(model), i)];
}

int hn_part_find_coordinate(const hn_model *model, const char *name, hn_diag *diag) {
    const char *names[MAX_COORDINATES];
    const int all = hn_system_get_info(hn_model_system(model)).n_user;
    const int n = all < MAX_COORDINATES ? all : MAX_COORDINATES;
    for (int i = 0; i < n; i++) {
        names[i] = hn_part_coordinate(model, i)->name;
        if (strcmp(names[i], name) == 0) {
            return i;
        }
    }
    char hint[HN_DIAG_HINT];
    hn_suggest_or_list(hint, name, names, n, "coordinates: ");
    hn_diag_set(diag, HN_ERR_INPUT, "/parts", hint, "the scene has no free coordinate '%.40s'",
                name);
    return -1;
}
