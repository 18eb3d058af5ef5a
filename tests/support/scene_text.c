// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/scene_text.h"

#include "support/near.h"

#include <string.h>

hn_scene *hn_test_scene(const char *text) {
    hn_scene *scene = NULL;
    hn_diags diags = {0};
    if (hn_scene_load_json(text, strlen(text), NULL, NULL, 0, &scene, &diags) != HN_OK) {
        fail_msg("%s: %s: %s (%s)", text, diags.item[0].pointer, diags.item[0].message,
                 diags.item[0].hint);
    }
    return scene;
}

int hn_test_count_shapes(const hn_scene *scene, hn_shape_kind kind) {
    int n = 0;
    for (int i = 0; i < scene->n_shapes; i++) {
        n += scene->shapes[i].kind == kind;
    }
    return n;
}
