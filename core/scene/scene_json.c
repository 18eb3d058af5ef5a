// SPDX-License-Identifier: GPL-3.0-or-later
// The loader: text -> checked tree -> scene. The order of the parts is the order in which names
// become known: parameters, bodies, joints or Lagrangian (coordinates), points, loads, shapes,
// start.

#include "scene/reader.h"

#include "base/file.h"
#include "base/hash.h"
#include "base/json_text.h"
#include "base/units.h"
#include "base/visible.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- head ----

static void read_version(hn_reader *r, const cJSON *root) {
    const cJSON *version = hn_rd_get(root, "holonom");
    if (!version) {
        hn_rd_fault(r, "start the scene with \"holonom\": 1",
                    "the field 'holonom' (version of the format) is missing");
    } else if (!cJSON_IsNumber(version) || version->valuedouble != 1) {
        hn_rd_fault_at(r, "holonom", "write 1",
                       "unknown version of the format; this program reads version 1");
    }
}

/// A number that must be positive, within a bound.
static double read_positive(hn_reader *r, const cJSON *root, const char *key, double fallback,
                            double bound) {
    hn_quantity q;
    if (hn_rd_member(r, root, key, 0, fallback, &q, HN_RD_CONST) &&
        !(q.value > 0 && q.value <= bound)) {
        hn_rd_fault_at(r, key, NULL, "%s = %.*g s, expected more than 0 and at most %g s", key,
                       hn_digits_apart(q.value, bound, 6), q.value, bound);
    }
    return q.value;
}

static void read_methods(hn_reader *r, const cJSON *root) {
    const cJSON *node = hn_rd_get(root, "methods");
    const char **methods = NULL;
    size_t mark = hn_rd_enter(r, "methods");
    int index = 0;
    if (node && !cJSON_IsArray(node)) {
        hn_rd_fault(r, "as in [\"index1@rk4:h=1e-3\"]", "expected a list of methods, found %s",
                    hn_rd_kind(node));
    }

    // each is checked for its form only: scene/ knows no methods
    for (const cJSON *m = cJSON_IsArray(node) ? node->child : NULL; m && !hn_rd_stopped(r);
         m = m->next, index++) {
        size_t inner = hn_rd_enter_index(r, index);
        if (!cJSON_IsString(m) || !strchr(m->valuestring, '@')) {
            hn_rd_fault(r, "as in \"index1@rk4:h=1e-3\"",
                        "expected FORMULATION@INTEGRATOR, found %s", hn_rd_kind(m));
        } else if ((methods = hn_rd_grow(r, methods, r->scene->n_methods, sizeof *methods, 100,
                                         "methods"))) {
            methods[r->scene->n_methods++] = hn_rd_keep(r, m->valuestring);
        }
        hn_rd_leave(r, inner);
    }
    r->scene->methods = methods;
    hn_rd_leave(r, mark);
}

static void read_head(hn_reader *r, const cJSON *root, const char *id) {
    hn_scene *s = r->scene;
    const char *own = hn_rd_name(r, root, "id", 0), *text;
    s->name = hn_rd_name(r, root, "name", 1);
    s->id = id ? hn_rd_keep(r, id) : own ? own : s->name;
    s->title = (text = hn_rd_text(r, root, "title", 0)) ? text : s->name;
    s->about = (text = hn_rd_text(r, root, "about", 0)) ? text : "";
    s->look_for = (text = hn_rd_text(r, root, "look_for", 0)) ? text : "";
    s->exhibit = (text = hn_rd_text(r, root, "exhibit", 0)) ? text : "";
    s->duration = read_positive(r, root, "duration", 10, 1e6);
    s->step = read_positive(r, root, "step", 1e-3, 1e6);
    read_methods(r, root);
}

// ---- body ----

static void read_gravity(hn_reader *r, const cJSON *root) {
    const cJSON *node = hn_rd_get(root, "gravity");
    size_t mark = hn_rd_enter(r, "gravity");
    if (node && r->scene->is_lagrangian) {
        hn_rd_fault(r, "gravity belongs in 'potential'", "a Lagrangian scene has no 'gravity'");
    } else if (node) {
        hn_rd_vector(r, node, r->scene->gravity, HN_RD_CONST);
    }
    hn_rd_leave(r, mark);
}

/// Reads whether the scene is one of bodies or of formulas. Returns false after a fault.
static bool read_kind(hn_reader *r, const cJSON *root) {
    const cJSON *bodies = hn_rd_get(root, "bodies"), *joints = hn_rd_get(root, "joints");
    const int formulas = hn_rd_get(root, "lagrangian") != NULL;
    r->scene->is_lagrangian = formulas && !bodies && !joints;
    r->scene->has_formulas = formulas && !r->scene->is_lagrangian;
    if (!r->scene->is_lagrangian && (!bodies || !joints)) {
        return hn_rd_fault(r, NULL,
                           "a scene needs 'bodies' and 'joints', or 'lagrangian'; %s missing",
                           bodies   ? "'joints' is"
                           : joints ? "'bodies' is"
                                    : "all three are");
    }
    return true;
}

static void read_mechanism(hn_reader *r, const cJSON *root) {
    // what moves
    if (r->scene->is_lagrangian) {
        hn_rd_lagrangian(r, root);
    } else {
        hn_rd_bodies(r, root);
        hn_rd_joints(r, root);
        if (r->n_faults == 0 && r->scene->n_bodies == 0) {
            hn_rd_fault_at(r, "bodies", NULL, "the scene has no body");
        } else if (r->n_faults == 0) {
            hn_rd_check_connected(r);
        }
        if (r->n_faults == 0 && r->scene->has_formulas) {
            hn_rd_lagrangian(r, root);
        }
    }

    // what refers to names that a fault kept out would only repeat that fault
    if (r->n_faults == 0 && !r->oom) {
        hn_rd_points(r, root);
    }
    if (r->n_faults == 0 && !r->oom) {
        hn_rd_constraints(r, root);
        hn_rd_loads(r, root);
        hn_rd_shapes(r, root);
        hn_rd_start(r, root);
    }
    if (r->n_faults == 0 && !r->oom) {
        hn_rd_draw_default(r, root);
    }
}

static void read_root(hn_reader *r, const cJSON *root, const char *id) {
    static const char *const fields[] = {
        "holonom",    "id",      "name",     "title",  "about",       "look_for", "exhibit",
        "parameters", "gravity", "bodies",   "joints", "constraints", "loads",    "lagrangian",
        "draw",       "start",   "duration", "step",   "methods"};

    // faults of JSON first: names used twice, numbers not finite
    hn_rd_check_tree(r, root);
    if (r->n_faults > 0 ||
        !hn_rd_object(r, root, "a scene", fields, sizeof fields / sizeof fields[0])) {
        return;
    }

    // parameters before everything that uses them
    read_version(r, root);
    int faults = r->n_faults;
    hn_rd_params(r, root);
    if (r->n_faults > faults) {
        return; // every formula would fail again
    }
    read_head(r, root, id);
    if (read_kind(r, root)) {
        read_gravity(r, root);
        read_mechanism(r, root);
    }
}

// ---- reading it all ----

/// Removes what is only said or shown, at any depth.
static void strip_words(cJSON *node) {
    static const char *const words[] = {"title", "about", "draw"};
    for (size_t i = 0; cJSON_IsObject(node) && i < sizeof words / sizeof *words; i++) {
        cJSON_DeleteItemFromObjectCaseSensitive(node, words[i]);
    }
    for (cJSON *child = node->child; child; child = child->next) {
        if (!child->string ||
            strcmp(child->string, "start") != 0) { // there, members are coordinates
            strip_words(child);
        }
    }
}

/// Hash of what moves, normalised, and of the present parameters: not of words, drawing, what
/// is compared by default, or bounds of parameters.
static bool calc_hash(hn_reader *r, const cJSON *root) {
    static const char *const shown[] = {"id",      "name",     "look_for", "exhibit",
                                        "methods", "duration", "step",     "parameters"};

    // the tree without what is only shown
    cJSON *meaning = cJSON_Duplicate(root, 1);
    for (size_t i = 0; meaning && i < sizeof shown / sizeof *shown; i++) {
        cJSON_DeleteItemFromObjectCaseSensitive(meaning, shown[i]);
    }
    if (meaning) {
        strip_words(meaning);
    }
    char *text = meaning ? cJSON_PrintUnformatted(meaning) : NULL;
    cJSON_Delete(meaning);
    if (!text) {
        return false;
    }

    // its text, then the names and values of the parameters
    uint64_t hash = hn_hash_text(HN_HASH_START, text);
    for (int i = 0; i < r->scene->n_params; i++) {
        hash = hn_hash_text(hash, r->scene->params[i].name);
        hash = hn_hash_double(hash, r->scene->params[i].value);
    }
    r->scene->hash = hn_hash_mix(hash);
    cJSON_free(text);
    return true;
}

static bool keep_text(hn_reader *r, const cJSON *root) {
    char *text = cJSON_PrintUnformatted(root);
    r->scene->text = hn_arena_strdup(r->arena, text);
    cJSON_free(text);
    return r->scene->text != NULL;
}

static hn_status read_tree(hn_reader *r, const cJSON *root, const char *id) {
    r->graph = hn_graph_create();
    if (!r->graph) {
        return HN_ERR_MEMORY;
    }
    read_root(r, root, id);
    if (r->n_faults == 0 && !r->oom && !(calc_hash(r, root) && keep_text(r, root))) {
        r->oom = true;
    }
    if (r->oom || hn_arena_failed(r->arena) || hn_graph_failed(r->graph)) {
        return HN_ERR_MEMORY;
    }
    return r->n_faults > 0 ? r->status : HN_OK;
}

/// Sound JSON only: what cJSON then refuses can only be memory.
static hn_status parse_text(const char *text, size_t n, cJSON **root, hn_diags *diags) {
    hn_diag diag = {0};
    *root = NULL;
    if (n > HN_SCENE_MAX_BYTES) {
        return hn_diags_add(diags, HN_ERR_LIMIT, "", NULL,
                            "the scene has %zu bytes, at most %d are allowed", n,
                            HN_SCENE_MAX_BYTES);
    }
    hn_status status = hn_json_text_check(text, n, HN_RD_MAX_DEPTH, &diag);
    if (status != HN_OK) {
        return hn_diags_add(diags, status, diag.pointer, diag.hint, "%s", diag.message);
    }
    *root = cJSON_ParseWithLength(text, n);
    return *root ? HN_OK : HN_ERR_MEMORY;
}

/// The object of this name in a parent, made if it is not there; NULL when something else is.
static cJSON *object_in(cJSON *parent, const char *name) {
    cJSON *there = cJSON_GetObjectItemCaseSensitive(parent, name);
    if (!there) {
        there = cJSON_AddObjectToObject(parent, name);
    }
    return cJSON_IsObject(there) ? there : NULL;
}

/// Puts the settings of the start into the scene, where its hash and its text contain them.
static void move_start(cJSON *root, const hn_setting *settings, int n) {
    for (int i = 0; i < n && cJSON_IsObject(root); i++) {
        const char *name = hn_scene_start_name(settings[i].name);
        cJSON *start = name ? object_in(root, "start") : NULL;
        cJSON *moved = start ? object_in(start, "moved") : NULL;
        if (moved) {
            cJSON_DeleteItemFromObjectCaseSensitive(moved, name);
            cJSON_AddNumberToObject(moved, name, settings[i].value);
        }
    }
}

hn_status hn_scene_load_json(const char *text, size_t n, const char *id, const hn_setting *settings,
                             int n_settings, hn_scene **out, hn_diags *diags) {
    HN_ASSERT(out && (text || n == 0) && (settings || n_settings == 0));
    *out = NULL;
    cJSON *root;
    hn_status status = parse_text(text, n, &root, diags);

    // the scene lives in an arena, the reader only as long as this call
    hn_arena *arena = status == HN_OK ? hn_arena_create(1 << 16) : NULL;
    hn_scene *scene = arena ? hn_arena_get(arena, sizeof *scene) : NULL;
    hn_reader *r = scene ? calloc(1, sizeof *r) : NULL;
    if (status == HN_OK && !r) {
        status = HN_ERR_MEMORY;
    }
    if (status == HN_OK) {
        move_start(root, settings, n_settings);
        scene->arena = arena;
        r->scene = scene;
        r->arena = arena;
        r->diags = diags;
        r->settings = settings;
        r->n_settings = n_settings;
        status = read_tree(r, root, id);
    }

    // all or nothing
    if (status == HN_OK) {
        *out = scene;
    } else {
        hn_arena_free(arena);
    }
    if (r) {
        hn_graph_free(r->graph);
    }
    free(r);
    cJSON_Delete(root);
    return status;
}

hn_status hn_scene_load_file(const char *path, const hn_setting *settings, int n_settings,
                             hn_scene **out, hn_diags *diags) {
    HN_ASSERT(path && out);
    *out = NULL;
    hn_strbuf text, visible;
    hn_strbuf_init(&text);
    hn_strbuf_init(&visible);
    hn_status status = hn_file_load(path, HN_SCENE_MAX_BYTES, &text, diags);

    // id: the file's name without folder and .json, with '?' for what a terminal would obey
    const char *base = strrchr(path, '/') ? strrchr(path, '/') + 1 : path;
    size_t length = strlen(base);
    char id[HN_RD_MAX_NAME + 1];
    if (length > 5 && strcmp(base + length - 5, ".json") == 0) {
        length -= 5;
    }
    snprintf(id, sizeof id, "%.*s", (int)(length < HN_RD_MAX_NAME ? length : HN_RD_MAX_NAME), base);
    hn_visible_add(&visible, id, true);

    HN_THEN(status, hn_scene_load_json(hn_strbuf_text(&text), text.n, hn_strbuf_text(&visible),
                                       settings, n_settings, out, diags));
    hn_strbuf_reset(&visible);
    hn_strbuf_reset(&text);
    return status;
}
