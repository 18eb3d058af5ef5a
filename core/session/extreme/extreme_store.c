// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/extreme/extreme_store.h"

#include "session/extreme/extreme_internal.h"
#include "session/extreme/extreme_verdict.h"
#include "session/store/stored_json.h"

#include "base/file.h"
#include "base/hash.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { FORMAT = 1 }; // FORMAT counts up when the meaning of a line changes

static hn_status hash_file(const char *path, uint64_t *hash, hn_diags *diags) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    const hn_status status = hn_file_load(path, HN_SCENE_MAX_BYTES, &text, diags);
    *hash = hn_hash_bytes(*hash, hn_strbuf_text(&text), text.n);
    hn_strbuf_reset(&text);
    return status;
}

/// Hashes everything that results depend on: the files of the cases and the scenes they name.
static hn_status find_key(const hn_extreme *x, uint64_t *key, hn_diags *diags) {
    uint64_t hash = hn_hash_double(x->hash, FORMAT);
    const char *last = "";
    hn_status status = HN_OK;
    for (int i = 0; i < x->n_cases; i++) {
        for (int k = 0; k < x->cases[i].n_trials; k++) {
            const hn_extreme_trial *t = &x->cases[i].trials[k];
            for (int s = 0; s < t->n_scenes && status == HN_OK; s++) {
                const char *id = t->scenes[s]->shipped;
                const char *path = id ? hn_library_scene_path(x->lib, id) : NULL;
                if (path && strcmp(id, last) != 0) { // most trials name the scene of the one before
                    status = hash_file(path, &hash, diags);
                    last = id;
                }
            }
        }
    }
    *key = hn_hash_mix(hash);
    return status;
}

static bool take_seen(const cJSON *o, hn_extreme_seen *seen) {
    return hn_stored_number(o, "value", &seen->value) &&
           hn_stored_text(o, "word", seen->word, sizeof seen->word) &&
           hn_stored_text(o, "reason", seen->reason, sizeof seen->reason);
}

static int take_line(void *user, const cJSON *o) {
    hn_extreme *x = user;
    int i, k, n = 0;

    // the trial that the line belongs to
    if (!hn_stored_int(o, "case", x->n_cases, &i) ||
        !hn_stored_int(o, "trial", x->cases[i].n_trials, &k)) {
        return 0;
    }
    hn_extreme_trial *t = &x->cases[i].trials[k];

    // a line holds a result for each scene and method of the trial
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(o, "seen"), *item;
    if (cJSON_GetArraySize(list) != t->n_scenes * t->n_methods) {
        return 0;
    }

    cJSON_ArrayForEach(item, list) {
        hn_extreme_seen *seen = &t->seen[n];
        *seen = (hn_extreme_seen){.scene = t->scenes[n / t->n_methods]->name,
                                  .method = t->methods[n % t->n_methods]};
        if (!take_seen(item, seen)) {
            return 0;
        }
        n++;
    }

    // counts as resumed once, even if the line is there twice
    x->resumed += t->n_seen == 0;
    hn_extreme_conclude(t);
    return 1;
}

hn_status hn_extreme_resume(hn_extreme *x, const char *folder, hn_diags *diags) {
    uint64_t key = 0;
    HN_TRY(find_key(x, &key, diags));
    return hn_journal_open(&x->journal, folder, "extreme", key, take_line, x, diags);
}

void hn_extreme_keep(hn_extreme *x, int i, int k) {
    const hn_extreme_trial *t = &x->cases[i].trials[k];
    hn_strbuf b;
    hn_strbuf_init(&b);

    // the place of the trial in the matrix
    hn_json_object(&b);
    hn_json_put_int(&b, "case", i);
    hn_json_put_int(&b, "trial", k);

    // its results, in the order of scenes and methods
    hn_json_key(&b, "seen");
    hn_json_array(&b);
    int whole = 1;
    for (int n = 0; n < t->n_seen; n++) {
        hn_json_object(&b);
        hn_json_put_number(&b, "value", t->seen[n].value);
        hn_json_put_string(&b, "word", t->seen[n].word);
        hn_json_put_string(&b, "reason", t->seen[n].reason);
        hn_json_end_object(&b);
        whole &= !isinf(t->seen[n].value);
    }
    hn_json_end_array(&b);

    // infinity has no JSON number: such a trial is run again next time
    if (whole) {
        hn_journal_write(&x->journal, &b);
    } else {
        hn_strbuf_reset(&b);
    }
}
