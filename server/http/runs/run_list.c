// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/runs/run_list.h"

#include "http/runs/run_folder.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/// A run of the list, and what is known of its file.
typedef struct entry {
    char id[HN_RUN_ID];
    bool in_memory;
    bool is_whole; ///< its file, when it had this stamp
    hn_run_stamp stamp;
} entry;

typedef struct entries {
    entry *item;
    size_t n, cap;
    bool failed; ///< memory is out
} entries;

struct hn_run_list {
    pthread_mutex_t lock;
    const char *folder;
    entries seen; ///< as the last list left them, by id
};

hn_run_list *hn_run_list_create(const char *folder) {
    hn_run_list *list = calloc(1, sizeof *list);
    if (list) {
        pthread_mutex_init(&list->lock, NULL);
        list->folder = folder;
    }
    return list;
}

void hn_run_list_free(hn_run_list *list) {
    if (list) {
        pthread_mutex_destroy(&list->lock);
        free(list->seen.item);
        free(list);
    }
}

static void add(entries *all, const char *id, bool in_memory) {
    if (all->n == all->cap) {
        const size_t cap = 2 * all->cap + 64;
        entry *larger = realloc(all->item, cap * sizeof *larger);
        if (!larger) {
            all->failed = true;
            return;
        }
        all->item = larger;
        all->cap = cap;
    }
    entry *e = &all->item[all->n++];
    memset(e, 0, sizeof *e);
    memcpy(e->id, id, HN_RUN_ID);
    e->in_memory = in_memory;
}

static void add_kept(void *user, const char *id) {
    add(user, id, true);
}

static void add_file(void *user, const char *id) {
    add(user, id, false);
}

/// By id; of two with one id the one in memory comes first.
static int compare(const void *a, const void *b) {
    const entry *x = a, *y = b;
    const int order = strcmp(x->id, y->id);
    return order != 0 ? order : y->in_memory - x->in_memory;
}

static int compare_ids(const void *a, const void *b) {
    return strcmp(((const entry *)a)->id, ((const entry *)b)->id);
}

/// All runs, each once, by id.
static entries collect(hn_runs *runs, const char *folder) {
    entries all = {0};
    hn_runs_list(runs, add_kept, &all);
    hn_run_folder_each(folder, add_file, &all);
    if (all.n > 0) {
        qsort(all.item, all.n, sizeof *all.item, compare);
    }
    size_t n = 0;
    for (size_t i = 0; i < all.n; i++) {
        if (n == 0 || strcmp(all.item[n - 1].id, all.item[i].id) != 0) {
            all.item[n++] = all.item[i];
        }
    }
    all.n = n;
    return all;
}

/// A copy of what the last list left; an empty one when memory is out, and files are read again.
static entries copy_seen(hn_run_list *list) {
    entries copy = {0};
    pthread_mutex_lock(&list->lock);
    const size_t bytes = list->seen.n * sizeof *copy.item;
    copy.item = bytes > 0 ? malloc(bytes) : NULL;
    if (copy.item) {
        memcpy(copy.item, list->seen.item, bytes);
        copy.n = copy.cap = list->seen.n;
    }
    pthread_mutex_unlock(&list->lock);
    return copy;
}

/// Takes what this list has found, for the next one.
static void keep_seen(hn_run_list *list, const entries *all) {
    pthread_mutex_lock(&list->lock);
    free(list->seen.item);
    list->seen = *all;
    pthread_mutex_unlock(&list->lock);
}

/// Reads a file, unless it was found whole before and is as it was then.
static void check(entry *e, const entries *seen, const char *folder) {
    const entry *before = seen->n ? bsearch(e, seen->item, seen->n, sizeof *e, compare_ids) : NULL;
    const bool there = hn_run_folder_stamp(folder, e->id, &e->stamp);
    const bool known = there && before && before->is_whole &&
                       memcmp(&before->stamp, &e->stamp, sizeof e->stamp) == 0;
    if (known || !there) {
        e->is_whole = known;
        return;
    }
    hn_kept_run *run = hn_run_folder_read(folder, e->id);
    e->is_whole = run != NULL;
    hn_kept_run_free(run);
}

void hn_run_list_put(hn_strbuf *b, hn_run_list *list, hn_runs *runs, hn_interrupt interrupt) {
    // without the lock: the work makes way for other requests, which may be lists too
    entries all = collect(runs, list->folder), seen = copy_seen(list);
    int spoilt = 0, unchecked = 0;
    hn_json_key(b, "runs");
    hn_json_array(b);
    for (size_t i = 0; i < all.n; i++) {
        entry *e = &all.item[i];
        const bool ended = !e->in_memory && hn_interrupt_ask(&interrupt);
        if (!e->in_memory && !ended) {
            check(e, &seen, list->folder);
        }
        if (e->in_memory || e->is_whole) {
            hn_json_string(b, e->id);
        }
        spoilt += !e->in_memory && !ended && !e->is_whole;
        unchecked += ended;
    }

    hn_json_end_array(b);
    hn_json_put_int(b, "spoilt", spoilt);
    hn_json_put_int(b, "unchecked", unchecked);
    b->failed |= all.failed;
    free(seen.item);
    keep_seen(list, &all);
}
