// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/versions.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

hn_versions *hn_versions_create(void) {
    return calloc(1, sizeof(hn_versions));
}

void hn_versions_free(hn_versions *v) {
    free(v);
}

static void copy_present(hn_version *to, const hn_workbench *w) {
    memset(to, 0, sizeof *to);
    snprintf(to->scene, sizeof to->scene, "%s", w->scene);
    to->n_settings = w->n_settings;
    for (int i = 0; i < w->n_settings; i++) {
        snprintf(to->names[i], sizeof to->names[i], "%s", w->settings[i].name);
        to->values[i] = w->settings[i].value;
    }
    to->n_methods = w->n_methods;
    for (int i = 0; i < w->n_methods; i++) {
        snprintf(to->methods[i], sizeof to->methods[i], "%s", w->methods[i]);
    }
}

void hn_versions_keep(hn_workbench *w) {
    hn_versions *v = w->versions;
    hn_version *fresh = malloc(sizeof *fresh);
    if (!v || v->going || !fresh) {
        free(fresh);
        return;
    }
    copy_present(fresh, w);
    if (v->n == 0 || memcmp(fresh, &v->at[v->now], sizeof *fresh) != 0) {
        // the oldest one goes when there is no room
        v->n = v->n > 0 ? v->now + 1 : 0;
        if (v->n == HN_TUI_VERSIONS) {
            memmove(v->at, v->at + 1, (HN_TUI_VERSIONS - 1) * sizeof *v->at);
            v->n--;
        }
        v->now = v->n;
        v->at[v->n++] = *fresh;
    }
    free(fresh);
}

/// The value of a setting; NULL: it is not set.
static const double *value_of(const hn_version *v, const char *name) {
    for (int i = 0; i < v->n_settings; i++) {
        if (strcmp(v->names[i], name) == 0) {
            return &v->values[i];
        }
    }
    return NULL;
}

/// The first setting that differs, and how many do.
static int change_of_settings(const hn_version *a, const hn_version *b, char *out, size_t size) {
    int n = 0;
    for (int i = 0; i < b->n_settings; i++) {
        const double *before = value_of(a, b->names[i]);
        if ((!before || *before != b->values[i]) && n++ == 0) {
            snprintf(out, size, "%s = %.9g", b->names[i], b->values[i]);
        }
    }
    for (int i = 0; i < a->n_settings; i++) {
        if (!value_of(b, a->names[i]) && n++ == 0) {
            snprintf(out, size, "%s as the scene has it", a->names[i]);
        }
    }
    return n;
}

/// The first method that differs, and how many do; one that was added or removed counts alone.
static int change_of_methods(const hn_version *a, const hn_version *b, char *out, size_t size) {
    int n = 0;
    for (int i = 0; i < a->n_methods || i < b->n_methods; i++) {
        const bool differ =
            i >= a->n_methods || i >= b->n_methods || strcmp(a->methods[i], b->methods[i]) != 0;
        if (differ && a->n_methods > b->n_methods) {
            snprintf(out, size, "without %s", a->methods[i]);
            return 1;
        }
        if (differ && a->n_methods < b->n_methods) {
            snprintf(out, size, "with %s", b->methods[i]);
            return 1;
        }
        if (differ && n++ == 0) {
            snprintf(out, size, "method %d is %s", i + 1, b->methods[i]);
        }
    }
    return n;
}

void hn_versions_change(const hn_versions *v, int from, int to, char *out, size_t size) {
    const hn_version *a = &v->at[from], *b = &v->at[to];
    char what[HN_TUI_LINE] = "";
    if (strcmp(a->scene, b->scene) != 0) {
        snprintf(out, size, "scene %.100s", b->scene);
        return;
    }
    int n = change_of_settings(a, b, what, sizeof what);
    if (n == 0) {
        n = change_of_methods(a, b, what, sizeof what);
    }
    snprintf(out, size, "%.160s%s", what, n > 1 ? ", and more" : "");
}
