// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/undo.h"

#include "tui/versions.h"

#include <string.h>

void hn_undo_go(hn_workbench *w, int by) {
    hn_versions *v = w->versions;
    const int to = v->now + by;
    if (to < 0 || to >= v->n) {
        hn_workbench_say(w, by < 0 ? "there is nothing to undo" : "there is nothing to redo");
        return;
    }

    // opened as it was
    const hn_version *one = &v->at[to];
    hn_setting settings[HN_TUI_SETTINGS];
    const char *methods[HN_COMPARISON_MAX_METHODS];
    for (int i = 0; i < one->n_settings; i++) {
        settings[i] = (hn_setting){one->names[i], one->values[i]};
    }
    for (int i = 0; i < one->n_methods; i++) {
        methods[i] = one->methods[i];
    }
    const double t = hn_workbench_moment(w);
    const bool same_scene = strcmp(one->scene, w->scene) == 0;
    v->going = true;
    const bool good =
        hn_workbench_reopen(w, one->scene, settings, one->n_settings, methods, one->n_methods);
    v->going = false;
    if (good && same_scene) {
        hn_workbench_go_to(w, t);
    }
    if (good) {
        char change[HN_TUI_LINE];
        hn_versions_change(v, v->now, to, change, sizeof change);
        v->now = to;
        hn_workbench_say(w, "%s: change %d of %d; now %s%s", by < 0 ? "undone" : "done again",
                         by < 0 ? to + 1 : to, v->n - 1, change,
                         same_scene ? "" : ", with its methods of then, at t = 0");
    }
}
