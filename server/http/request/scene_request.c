// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/request/scene_request.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static void forget_settings(hn_scene_request *order) {
    for (int i = 0; i < order->n; i++) {
        free(order->names[i]);
    }
    order->n = 0;
}

void hn_scene_request_reset(hn_scene_request *order) {
    forget_settings(order);
    free(order->name);
    cJSON_free(order->text);
    order->name = order->text = NULL;
}

hn_status hn_scene_request_add(hn_scene_request *order, const char *name, size_t n_name,
                               double value, hn_diags *diags) {
    char pointer[HN_DIAG_POINTER];
    snprintf(pointer, sizeof pointer, "/parameters/%.*s", (int)(n_name < 100 ? n_name : 100), name);
    if (!isfinite(value)) {
        return hn_diags_add(diags, HN_ERR_INPUT, pointer, NULL, "the value is not a finite number");
    }
    if (order->n == HN_SCENE_MAX_PARAMS) {
        return hn_diags_add(diags, HN_ERR_LIMIT, "/parameters", NULL,
                            "more than %d parameters were given", HN_SCENE_MAX_PARAMS);
    }
    for (int i = 0; i < order->n; i++) {
        if (strlen(order->names[i]) == n_name && memcmp(order->names[i], name, n_name) == 0) {
            return hn_diags_add(diags, HN_ERR_INPUT, pointer, NULL,
                                "the parameter '%.60s' is given twice", order->names[i]);
        }
    }
    char *copy = strndup(name, n_name);
    if (!copy) {
        return HN_ERR_MEMORY;
    }
    order->names[order->n] = copy;
    order->settings[order->n] = (hn_setting){.name = copy, .value = value};
    order->n++;
    return HN_OK;
}

hn_status hn_scene_request_set(hn_scene_request *order, const hn_setting *setting,
                               hn_diags *diags) {
    for (int i = 0; i < order->n; i++) {
        if (strcmp(order->names[i], setting->name) == 0) {
            order->settings[i].value = setting->value;
            return HN_OK;
        }
    }
    return hn_scene_request_add(order, setting->name, strlen(setting->name), setting->value, diags);
}

hn_status hn_scene_request_read_settings(hn_scene_request *order, const cJSON *settings,
                                         hn_diags *diags) {
    forget_settings(order);
    const cJSON *item;
    cJSON_ArrayForEach(item, settings) {
        hn_status status = hn_scene_request_add(order, item->string, strlen(item->string),
                                                item->valuedouble, diags);
        if (status != HN_OK) {
            return status;
        }
    }
    return HN_OK;
}

hn_status hn_scene_request_read(hn_scene_request *order, const cJSON *body, hn_diags *diags) {
    const cJSON *scene = cJSON_GetObjectItemCaseSensitive(body, "scene");
    if (cJSON_IsString(scene)) {
        order->name = strdup(scene->valuestring);
    } else {
        order->text = cJSON_PrintUnformatted(scene);
    }
    if (!order->name && !order->text) {
        return HN_ERR_MEMORY;
    }
    return hn_scene_request_read_settings(
        order, cJSON_GetObjectItemCaseSensitive(body, "parameters"), diags);
}

hn_status hn_scene_request_add_pull(hn_scene_request *order, int point, hn_diags *diags) {
    for (int i = 0; i < order->n_pulls; i++) {
        if (order->pulls[i] == point) {
            return HN_OK;
        }
    }
    if (order->n_pulls == HN_SCENE_REQUEST_PULLS) {
        return hn_diags_add(
            diags, HN_ERR_LIMIT, "/pull/point", "send \"pulls\": [] to forget the pulls so far",
            "%d points were pulled already, which is the largest number", HN_SCENE_REQUEST_PULLS);
    }
    order->pulls[order->n_pulls++] = point;
    return HN_OK;
}

hn_status hn_scene_request_copy(hn_scene_request *to, const hn_scene_request *from) {
    *to = (hn_scene_request){.name = from->name ? strdup(from->name) : NULL};
    if (from->text) {
        size_t n = strlen(from->text) + 1;
        to->text = cJSON_malloc(n);
        if (to->text) {
            memcpy(to->text, from->text, n);
        }
    }
    if (!to->name && !to->text) {
        return HN_ERR_MEMORY;
    }
    to->n_pulls = from->n_pulls;
    memcpy(to->pulls, from->pulls, sizeof to->pulls);
    for (int i = 0; i < from->n; i++) {
        const hn_setting *s = &from->settings[i];
        hn_status status = hn_scene_request_add(to, s->name, strlen(s->name), s->value, NULL);
        if (status != HN_OK) {
            return status;
        }
    }
    return HN_OK;
}

/// Returns whether the last part of a pointer is this name, with '~' and '/' escaped.
static bool is_name(const char *part, const char *name) {
    while (*part && *name) {
        const char plain = *part != '~' ? *part : part[1] == '1' ? '/' : '~';
        if (plain != *name++ || *part == '/') {
            return false;
        }
        part += *part == '~' && part[1] ? 2 : 1;
    }
    return !*part && !*name;
}

/// Returns whether a place is a member of the request, not of the scene in it: both have
/// "parameters".
static bool is_of_request(const hn_scene_request *order, const char *pointer) {
    static const char parameters[] = "/parameters/";
    if (strncmp(pointer, "/scene", 6) == 0 || strncmp(pointer, "/pull", 5) == 0) {
        return true;
    }
    if (strncmp(pointer, parameters, sizeof parameters - 1) != 0) {
        return false;
    }
    for (int i = 0; i < order->n; i++) {
        if (is_name(pointer + sizeof parameters - 1, order->names[i])) {
            return true;
        }
    }
    return false;
}

/// Faults inside a scene object are told by their place in the body.
static void prefix_pointers(const hn_scene_request *order, hn_diags *diags, int first) {
    for (int i = first; i < diags->n; i++) {
        char *p = diags->item[i].pointer;
        if (!is_of_request(order, p)) {
            char longer[HN_DIAG_POINTER + 8];
            snprintf(longer, sizeof longer, "/scene%s", p);
            snprintf(p, HN_DIAG_POINTER, "%.*s", HN_DIAG_POINTER - 1, longer);
        }
    }
}

hn_status hn_scene_request_load(const hn_scene_request *order, const hn_library *lib,
                                bool allow_open, hn_interrupt interrupt, hn_model **out,
                                hn_diags *diags) {
    int first = diags->n;
    hn_model_source source = {.name = order->name,
                              .text = order->text,
                              .n_text = order->text ? strlen(order->text) : 0,
                              .settings = order->settings,
                              .n_settings = order->n,
                              .pulls = order->pulls,
                              .n_pulls = order->n_pulls,
                              .allow_open = allow_open,
                              .interrupt = interrupt};
    hn_status status = hn_model_load(lib, &source, out, diags);
    prefix_pointers(order, diags, first);
    return status;
}

void hn_scene_request_settings_json(hn_strbuf *b, const hn_scene_request *order) {
    hn_json_object(b);
    for (int i = 0; i < order->n; i++) {
        hn_json_put_number(b, order->settings[i].name, order->settings[i].value);
    }
    hn_json_end_object(b);
}
