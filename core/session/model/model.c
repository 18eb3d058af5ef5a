// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/model/model.h"

#include "base/units.h"
#include "dynamics/compile/compile.h"
#include "integrators/method/method_spec.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

struct hn_model {
    hn_scene *scene;
    hn_system *system;
    hn_arena *arena;
    double *q, *v;
    hn_assembly assembly;
    hn_diag open;          ///< why its loops did not close; no message: they did
    const char *reference; ///< where its shipped reference stands, NULL: it is no shipped scene
};

/// lessons/NN-topic/scenes/ID.json has its reference in lessons/NN-topic/references/ID.json.
static const char *find_reference(hn_arena *arena, const hn_library *lib, const char *id) {
    static const char from[] = "/scenes/", to[] = "/references/";
    const char *path = lib && id ? hn_library_scene_path(lib, id) : NULL, *last = NULL;
    for (const char *at = path; at && (at = strstr(at, from)) != NULL; at++) {
        last = at;
    }
    const size_t size = last ? strlen(path) + sizeof to : 0;
    char *out = last ? hn_arena_get(arena, size) : NULL;
    if (out) {
        snprintf(out, size, "%.*s%s%s", (int)(last - path), path, to, last + strlen(from));
    }
    return out;
}

static hn_status load_shipped(const hn_library *lib, const hn_model_source *source,
                              hn_scene **scene, hn_diags *diags) {
    HN_TRY(hn_library_check_scene(lib, source->name, "/scene", diags));
    return hn_scene_load_file(hn_library_scene_path(lib, source->name), source->settings,
                              source->n_settings, scene, diags);
}

static hn_status load_scene(const hn_library *lib, const hn_model_source *source, hn_scene **scene,
                            hn_diags *diags) {
    HN_ASSERT((source->name != NULL) + (source->path != NULL) + (source->text != NULL) == 1);
    if (source->name) {
        return load_shipped(lib, source, scene, diags);
    }
    if (source->path) {
        return hn_scene_load_file(source->path, source->settings, source->n_settings, scene, diags);
    }
    return hn_scene_load_json(source->text, source->n_text, source->id, source->settings,
                              source->n_settings, scene, diags);
}

/// Bytes of the beginning of a list that `room` bytes hold: whole parts between separators.
static int whole_parts(const char *list, size_t room, const char *separator) {
    size_t n = strlen(list);
    if (n > room) {
        for (n = room; n > 0 && strncmp(list + n, separator, strlen(separator)) != 0;) {
            n--;
        }
    }
    return (int)n;
}

/// Appends "NAME = VALUE" parts to a list of at most `room` bytes, while a remark on those left out
/// still fits behind them. Returns whether the part was appended.
static bool add_part(char *list, size_t room, const char *part) {
    const size_t used = strlen(list);
    if (used + strlen(part) + sizeof " and 1000 more" > room) {
        return false;
    }
    snprintf(list + used, room - used, "%s", part);
    return true;
}

/// Puts the parameters that were changed before the reason why a loop is open: "with l1 = 50 m (0.5
/// in the scene), loop B ...", and their former values before what else to try. Parameters that do
/// not fit are counted. Nothing where nothing was changed.
static void put_changes(const hn_scene *scene, hn_diag *why) {
    static const char OR[] = ", or ";
    char changes[HN_DIAG_MESSAGE / 2] = "", back[HN_DIAG_HINT / 2] = "", part[200];
    int left_out = 0;
    for (int i = 0; i < scene->n_params; i++) {
        const hn_param *p = &scene->params[i];
        if (p->value == p->initial) {
            continue;
        }
        const char *space = p->unit[0] ? " " : "";
        const int digits = hn_digits_apart(p->value, p->initial, 6);
        snprintf(part, sizeof part, "%s%.40s = %.*g%s%s (%.*g in the scene)",
                 changes[0] ? ", " : "with ", p->name, digits, p->value, space, p->unit, digits,
                 p->initial);
        left_out += left_out > 0 || !add_part(changes, sizeof changes, part);
        char usual[64] = "";
        if (p->beyond) {
            snprintf(usual, sizeof usual, " (usually %g to %g%s%.20s)", p->min, p->max, space,
                     p->unit);
        }
        snprintf(part, sizeof part, "%s%.40s = %.*g%s", back[0] ? ", " : "go back towards ",
                 p->name, digits, p->initial, usual);
        add_part(back, sizeof back, part);
    }
    if (changes[0]) {
        const hn_diag said = *why;
        if (left_out > 0) {
            const size_t used = strlen(changes);
            snprintf(changes + used, sizeof changes - used, " and %d more", left_out);
        }
        hn_diag_set(why, said.status, said.pointer, NULL, "%s, %s", changes, said.message);
        const size_t room = sizeof why->hint - 1 - strlen(back) - (sizeof OR - 1);
        const int n_said = whole_parts(said.hint, room, OR);
        snprintf(why->hint, sizeof why->hint, "%s%s%.*s", back, n_said > 0 ? OR : "", n_said,
                 said.hint);
    }
}

/// Computes consistent starting values. An open loop is an error unless allow_open is set.
static hn_status assemble(hn_model *model, const hn_model_source *source, hn_diags *diags) {
    hn_system_info info = hn_system_get_info(model->system);
    model->q = hn_arena_doubles(model->arena, (size_t)info.nq);
    model->v = hn_arena_doubles(model->arena, (size_t)info.nv);
    if (hn_arena_failed(model->arena)) {
        return HN_ERR_MEMORY;
    }
    hn_diags why = {0};
    hn_status status =
        hn_assemble(model->system, 0, model->q, model->v, NULL, NULL, &model->assembly, &why);
    int open = status == HN_ERR_UNREACHABLE || status == HN_ERR_INCONSISTENT;
    if (open && !source->hides_changes) {
        put_changes(model->scene, &why.item[0]);
    }
    if (open && source->allow_open) {
        model->open = why.item[0];
        return HN_OK;
    }
    for (int i = 0; i < why.n; i++) {
        hn_diags_add(diags, why.item[i].status, why.item[i].pointer, why.item[i].hint, "%s",
                     why.item[i].message);
    }
    return status;
}

static hn_status add_pulls(hn_scene *scene, const hn_model_source *source, hn_diags *diags) {
    for (int i = 0; i < source->n_pulls; i++) {
        const hn_status status = hn_scene_add_pull(scene, source->pulls[i]);
        if (status != HN_OK) {
            return hn_diags_add(diags, status, "/pull/point", NULL,
                                "point %d is not one of the scene's %d points", source->pulls[i],
                                scene->n_points);
        }
    }
    return HN_OK;
}

hn_status hn_model_load(const hn_library *lib, const hn_model_source *source, hn_model **out,
                        hn_diags *diags) {
    hn_arena *arena = hn_arena_create(0);
    hn_model *model = arena ? hn_arena_get(arena, sizeof *model) : NULL;
    if (!model) {
        hn_arena_free(arena);
        return hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }

    // scene, equations, consistent start
    const int n_before = diags ? diags->n : 0;
    model->arena = arena;
    hn_status status = load_scene(lib, source, &model->scene, diags);
    HN_THEN(status, add_pulls(model->scene, source, diags));
    hn_system_opts opts = hn_system_opts_default();
    opts.interrupt = source->interrupt;
    HN_THEN(status, hn_system_compile(model->scene, &opts, &model->system, diags));
    HN_THEN(status, assemble(model, source, diags));

    // the compiler's limit has no message of its own
    if (status == HN_ERR_LIMIT && diags && diags->n == 0) {
        hn_diags_add(diags, status, "/scene", "take fewer bodies, or shorter chains",
                     "the scene's equations need more values at once than compiled instructions "
                     "can hold (65,000)");
    }
    if (status != HN_OK) {
        if (source->path) {
            hn_diags_name_file(diags, n_before, source->path);
        }
        hn_model_free(model);
        return status;
    }

    // stored reference solution, if the scene has one
    model->reference = find_reference(arena, lib, model->scene->id);
    *out = model;
    return HN_OK;
}

void hn_model_free(hn_model *model) {
    if (model) {
        hn_system_free(model->system);
        hn_scene_free(model->scene);
        hn_arena_free(model->arena);
    }
}

const hn_scene *hn_model_scene(const hn_model *model) {
    return model->scene;
}

const char *const *hn_model_methods(const hn_model *model, int *n) {
    static const char *const of_loops[] = {"index1@rk4", "baumgarte@rk4", "projection@rk4"};
    static const char *const of_trees[] = {"index1@rk4", "index1@dopri5"};
    if (model->scene->n_methods > 0) {
        *n = model->scene->n_methods;
        return model->scene->methods;
    }
    const bool has_loops = hn_system_get_info(model->system).nc > 0;
    *n = has_loops ? 3 : 2;
    return has_loops ? of_loops : of_trees;
}

const char *hn_model_method(const hn_model *model) {
    int n;
    const char *const *methods = hn_model_methods(model, &n);
    for (int i = 0; i < n; i++) {
        hn_method_spec spec;
        hn_diag diag = {0};
        if (hn_method_parse(methods[i], &spec, &diag) == HN_OK &&
            (spec.formulation->traits & (HN_TRAIT_CLOSES_POSITION | HN_TRAIT_PULLS_GAP))) {
            return methods[i];
        }
    }
    return methods[0];
}

const char *hn_model_reference_path(const hn_model *model) {
    return model->reference;
}

const hn_system *hn_model_system(const hn_model *model) {
    return model->system;
}

const hn_assembly *hn_model_assembly(const hn_model *model) {
    return &model->assembly;
}

const hn_diag *hn_model_why_open(const hn_model *model) {
    return model->open.message[0] ? &model->open : NULL;
}

const double *hn_model_q(const hn_model *model) {
    return model->q;
}

const double *hn_model_v(const hn_model *model) {
    return model->v;
}
