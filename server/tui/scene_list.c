// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/scene_list.h"

#include "session/model/model_json.h"
#include "terminal/keys.h"
#include "tui/list.h"

#include <cjson/cJSON.h>
#include <ctype.h>
#include <stdio.h>
#include <string.h>

static const char *text_of(const cJSON *object, const char *name) {
    const cJSON *item = cJSON_GetObjectItem(object, name);
    return cJSON_IsString(item) ? item->valuestring : "";
}

/// Returns whether `word` (n characters, small letters) is part of the text, in any case.
static bool has_word(const char *text, const char *word, size_t n) {
    for (; *text; text++) {
        size_t k = 0;
        while (k < n && tolower((unsigned char)text[k]) == word[k]) {
            k++;
        }
        if (k == n) {
            return true;
        }
    }
    return false;
}

/// Texts of a scene that are searched: its names first.
static const char *const TEXTS[] = {"id", "title", "about", "look_for", "kind", "caption"};
enum { N_TEXTS = sizeof TEXTS / sizeof *TEXTS, N_NAMES = 2, RANKS = 4 };

/// Returns whether every word of the search is in one of the first n texts of the scene.
static bool fits(const cJSON *scene, const char *search, int n_texts) {
    bool all = true;
    for (const char *word = search; *word && all;) {
        const size_t n = strcspn(word, " ");
        bool found = n == 0;
        for (int i = 0; i < n_texts && !found; i++) {
            found = has_word(text_of(scene, TEXTS[i]), word, n);
        }
        all = found;
        word += n + (word[n] == ' ');
    }
    return all;
}

static void write_title(hn_workbench *w, int of) {
    if (w->n_search == 0) {
        snprintf(w->title, sizeof w->title, "scenes: type to search, Enter opens, Esc goes back");
    } else {
        snprintf(w->title, sizeof w->title, "scenes with '%.60s': %d of %d", w->search, w->n_items,
                 of);
    }
}

/// One scene more in the list.
static void list_scene(hn_workbench *w, const cJSON *scene) {
    hn_item *item = hn_list_add(w, text_of(scene, "id"), text_of(scene, "title"));
    if (item) {
        static const char ellipsis[] = "…";
        const int n = snprintf(item->more, sizeof item->more, "%s. %s. %s", text_of(scene, "title"),
                               text_of(scene, "caption"), text_of(scene, "about"));
        // cut at a blank, so that no character is cut
        if (n >= (int)sizeof item->more) {
            item->more[sizeof item->more - sizeof ellipsis] = '\0';
            char *blank = strrchr(item->more, ' ');
            if (blank) {
                snprintf(blank, sizeof ellipsis, "%s", ellipsis);
            }
        }
    }
    if (item && w->n_search == 0 && strcmp(item->name, w->scene) == 0) {
        w->cursor = w->n_items - 1;
    }
}

/// Returns how well a scene fits the search, 0 best: its name is what was typed; its name begins
/// so; every word is in its name or title; every word is somewhere. RANKS: it does not fit.
static int rank(const cJSON *scene, const char *search) {
    const char *id = text_of(scene, TEXTS[0]);
    const bool begins = strncmp(id, search, strlen(search)) == 0;
    return strcmp(id, search) == 0        ? 0
           : begins                       ? 1
           : fits(scene, search, N_NAMES) ? 2
           : fits(scene, search, N_TEXTS) ? 3
                                          : RANKS;
}

/// The scenes that fit, from the document that is read once, the best ones first.
static void list_fitting(hn_workbench *w) {
    const cJSON *scene, *scenes = cJSON_GetObjectItem(w->scenes, "scenes");
    hn_list_begin(w, HN_LIST_SCENES, "");
    for (int r = 0; r < RANKS; r++) {
        cJSON_ArrayForEach(scene, scenes) {
            if (rank(scene, w->search) == r) {
                list_scene(w, scene);
            }
        }
    }
    write_title(w, cJSON_GetArraySize(scenes));
    if (w->n_items == 0) {
        hn_workbench_say(w, "no scene has all of these words; Backspace takes a letter back");
    }
}

static void type(hn_workbench *w, int length) {
    w->n_search = length;
    w->search[length] = '\0';
    list_fitting(w);
}

void hn_scene_list_open(hn_workbench *w) {
    if (!w->scenes) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_scenes_json(&b, w->library);
        w->scenes = cJSON_Parse(hn_strbuf_text(&b));
        hn_strbuf_reset(&b);
    }
    type(w, 0);
}

bool hn_scene_list_key(hn_workbench *w, int key) {
    const bool character = key >= ' ' && key < 127 && (key != ' ' || w->n_search > 0);
    if (w->list != HN_LIST_SCENES || (!character && w->n_search == 0)) {
        return false;
    }
    if (key == HN_KEY_ESCAPE) {
        type(w, 0);
    } else if (key == HN_KEY_BACKSPACE) {
        type(w, w->n_search - 1);
    } else if (character && w->n_search + 1 < (int)sizeof w->search) {
        w->search[w->n_search] = (char)tolower(key);
        type(w, w->n_search + 1);
    } else {
        return character;
    }
    return true;
}
