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
