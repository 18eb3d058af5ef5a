// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene.h"

#include <string.h>

const char *hn_joint_type_name(hn_joint_type type) {
    static const char *const names[] = {
#define HN_JOINT_NAME(code, name) name,
        HN_JOINT_TYPE_LIST(HN_JOINT_NAME)
#undef HN_JOINT_NAME
    };
    HN_ASSERT((int)type >= 0 && type < HN_JOINT_TYPE_COUNT);
    return names[type];
}

int hn_scene_find_coordinate(const hn_scene *scene, const char *name) {
    for (int i = 0; i < scene->n_coordinates; i++) {
        if (strcmp(scene->coordinates[i].name, name) == 0) {
            return i;
        }
    }
    return -1;
}

int hn_scene_find_param(const hn_scene *scene, const char *name) {
    for (int i = 0; i < scene->n_params; i++) {
        if (strcmp(scene->params[i].name, name) == 0) {
            return i;
        }
    }
    return -1;
}

int hn_scene_find_body(const hn_scene *scene, const char *name) {
    if (strcmp(name, "ground") == 0) {
        return HN_GROUND;
    }
    for (int i = 0; i < scene->n_bodies; i++) {
        if (strcmp(scene->bodies[i].name, name) == 0) {
            return i;
        }
    }
    return -2;
}

hn_status hn_scene_add_pull(hn_scene *scene, int point) {
    if (point < 0 || point >= scene->n_points) {
        return HN_ERR_INPUT;
    }
    const size_t n = (size_t)scene->n_loads;
    hn_load *loads = hn_arena_get(scene->arena, (n + 1) * sizeof *loads);
    if (!loads) {
        return HN_ERR_MEMORY;
    }
    if (n > 0) {
        memcpy(loads, scene->loads, n * sizeof *loads);
    }
    loads[n] = (hn_load){
        .name = "pull", .pointer = "", .kind = HN_LOAD_PULL, .p = point, .q = -1, .coordinate = -1};
    scene->loads = loads;
    scene->n_loads++;
    return HN_OK;
}

void hn_scene_free(hn_scene *scene) {
    if (scene) {
        hn_arena_free(scene->arena); // the scene itself lives in it
    }
}

const char *hn_coordinate_unit(const hn_coordinate *c, const char *none) {
    return c->kind == HN_ANGLE ? "rad" : c->kind == HN_LENGTH ? "m" : none;
}

const char *hn_scene_start_name(const char *setting) {
    static const char prefix[] = "start.";
    const size_t n = sizeof prefix - 1;
    return setting && strncmp(setting, prefix, n) == 0 ? setting + n : NULL;
}
