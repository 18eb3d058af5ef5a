// SPDX-License-Identifier: GPL-3.0-or-later
// The loop file: what closes the loops of a URDF, which is a tree. JSON of ours:
//   {"holonom_loops": 1, "joints": [..], "constraints": [..], "gravity": [x, y, z],
//    "start": {"positions": {"th1": 1, ..}, "rates": {..}}}
// Joints and constraints are written as in a scene (scene.schema.json); bodies are links by name,
// places and directions in the frames of the links. Each joint is marked as cut. The start names
// joints of the model, each with a number, or a list for a joint of several coordinates.
#include "import/loops.h"

#include "base/json_text.h"
#include "base/suggest.h"

#include <cjson/cJSON.h>
#include <string.h>

enum { MAX_DEPTH = 32, MAX_ENTRIES = 4000 };

static bool fault(hn_build *b, const char *pointer, const char *hint, const char *message) {
    b->status = HN_ERR_INPUT;
    (void)hn_diags_add(b->diags, HN_ERR_INPUT, pointer, hint, "loop file: %s", message);
    return false;
}

static bool add_entry(hn_build *b, hn_im_texts *list, const cJSON *entry) {
    char *text = cJSON_PrintUnformatted(entry);
    hn_strbuf o;
    hn_strbuf_init(&o);
    hn_strbuf_add(&o, text ? text : "");
    o.failed |= !text;
    cJSON_free(text);
    return hn_im_add_text(b, list, &o);
}

static bool add_joint(hn_build *b, cJSON *entry) {
    const cJSON *cut = cJSON_GetObjectItemCaseSensitive(entry, "cut");
    if (!cut && !cJSON_AddTrueToObject(entry, "cut")) {
        return hn_im_out_of_memory(b);
    }
    if (cut && !cJSON_IsTrue(cut)) {
        return fault(b, "/joints", "leave 'cut' out",
                     "a joint of this file closes a loop, so it is cut");
    }
    b->n_closing++;
    return add_entry(b, &b->closing, entry);
}

/// The entries of a list under `key`; joints are marked.
static bool read_list(hn_build *b, const cJSON *root, const char *key) {
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(root, key);
    int joints = strcmp(key, "joints") == 0;
    if (list && !cJSON_IsArray(list)) {
        return fault(b, joints ? "/joints" : "/constraints", NULL, "expected a list");
    }
    if (cJSON_GetArraySize(list) > MAX_ENTRIES) {
        return fault(b, joints ? "/joints" : "/constraints", NULL, "more than 4000 entries");
    }
    for (cJSON *c = list ? list->child : NULL; c; c = c->next) {
        if (!cJSON_IsObject(c)) {
            return fault(b, joints ? "/joints" : "/constraints", NULL,
                         "expected objects in the list");
        }
        b->n_closing += !joints;
        if (!(joints ? add_joint(b, c) : add_entry(b, &b->constraints, c))) {
            return false;
        }
    }
    return true;
}

static bool read_gravity(hn_build *b, const cJSON *root) {
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(root, "gravity");
    if (!list) {
        return true;
    }
    int good = cJSON_IsArray(list) && cJSON_GetArraySize(list) == 3, k = 0;
    for (const cJSON *c = good ? list->child : NULL; c; c = c->next) {
        good &= cJSON_IsNumber(c);
        b->gravity[k++] = c->valuedouble;
    }
    return good || fault(b, "/gravity", "as in [0, 0, -9.81]", "expected three numbers");
}

/// Values of one joint: a number, or a list of as many as the joint has coordinates.
static bool read_value(hn_build *b, const cJSON *value, double *x, int n) {
    const int is_list = cJSON_IsArray(value);
    if (is_list ? cJSON_GetArraySize(value) != n : n != 1) {
        return fault(b, "/start", NULL, "a joint needs as many numbers as it has coordinates");
    }
    for (int k = 0; k < n; k++) {
        const cJSON *c = is_list ? cJSON_GetArrayItem(value, k) : value;
        if (!cJSON_IsNumber(c)) {
            return fault(b, "/start", NULL, "expected numbers");
        }
        x[k] = c->valuedouble;
    }
    return true;
}

/// Positions or rates of joints by their names in the model.
static bool read_values(hn_build *b, const cJSON *start, const char *key) {
    const cJSON *values = cJSON_GetObjectItemCaseSensitive(start, key);
    const int rates = strcmp(key, "rates") == 0;
    if (values && !cJSON_IsObject(values)) {
        return fault(b, "/start", NULL, "expected values by the names of joints");
    }
    for (const cJSON *c = values ? values->child : NULL; c; c = c->next) {
        const int joint = hn_im_find_joint(b, c->string);
        if (joint < 0) {
            return fault(b, hn_im_text(b, "/start/%s/%.60s", key, c->string), NULL,
                         "the model has no joint of this name");
        }
        hn_im_joint *j = &b->joints[joint];
        if (!read_value(b, c, rates ? j->v0 : j->q0, j->n)) {
            return false;
        }
    }
    return true;
}

static bool read_start(hn_build *b, const cJSON *root) {
    const cJSON *start = cJSON_GetObjectItemCaseSensitive(root, "start");
    if (!start) {
        return true;
    }
    if (!cJSON_IsObject(start)) {
        return fault(b, "/start", "as in {\"positions\": {\"th1\": 1}}", "expected an object");
    }
    for (const cJSON *c = start->child; c; c = c->next) {
        if (strcmp(c->string, "positions") != 0 && strcmp(c->string, "rates") != 0) {
            return fault(b, "/start", "positions or rates", "unknown field");
        }
    }
    return read_values(b, start, "positions") && read_values(b, start, "rates");
}

static bool read_document(hn_build *b, const cJSON *root) {
    static const char *const fields[] = {"holonom_loops", "about",   "joints",
                                         "constraints",   "gravity", "start"};
    enum { N_FIELDS = sizeof fields / sizeof *fields };
    if (!cJSON_IsObject(root)) {
        return fault(b, "", "as in {\"holonom_loops\": 1, \"joints\": [..]}", "expected an object");
    }

    // no field that nobody reads
    for (const cJSON *c = root->child; c; c = c->next) {
        bool known = 0;
        for (int k = 0; k < N_FIELDS; k++) {
            known |= strcmp(c->string, fields[k]) == 0;
        }
        if (!known) {
            char hint[HN_DIAG_HINT];
            return fault(b, hn_im_text(b, "/%.60s", c->string),
                         hn_suggest(hint, c->string, fields, N_FIELDS, NULL), "unknown field");
        }
    }

    // a version of the form, so that it may change one day
    const cJSON *version = cJSON_GetObjectItemCaseSensitive(root, "holonom_loops");
    if (!cJSON_IsNumber(version) || version->valuedouble != 1) {
        return fault(b, "/holonom_loops", "\"holonom_loops\": 1", "the version of this form is 1");
    }
    return read_list(b, root, "joints") && read_list(b, root, "constraints") &&
           read_gravity(b, root) && read_start(b, root);
}

bool hn_im_read_loops(hn_build *b, const char *text, size_t n) {
    hn_diag diag = {0};
    b->n_own_constraints = b->constraints.n;
    if (n > HN_IMPORT_MAX_BYTES) {
        return fault(b, "", NULL, "too many bytes");
    }
    if (hn_json_text_check(text, n, MAX_DEPTH, &diag) != HN_OK) {
        return fault(b, "", diag.hint, diag.message);
    }
    cJSON *root = cJSON_ParseWithLength(text, n);
    int good = root ? read_document(b, root) : hn_im_out_of_memory(b);
    cJSON_Delete(root);
    b->guess |= b->n_closing > 0;
    return good;
}
