// SPDX-License-Identifier: GPL-3.0-or-later
#include "expr/tape_store.h"

#include "base/hash.h"
#include "expr/tape_code.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef struct entry {
    uint64_t hash;
    hn_tape_key key; ///< copies
    hn_tape *tape;   ///< shares the code of those that were handed out
} entry;

struct hn_tape_store {
    entry *entries;
    int n, cap;
};

static uint64_t hash_of(const hn_tape_key *key) {
    uint64_t hash = HN_HASH_START;
    for (int k = 0; k < key->n_out; k++) {
        hash = hn_hash_bytes(hash, &key->outputs[k].c, sizeof key->outputs[k].c);
        hash = hn_hash_bytes(hash, &key->outputs[k].n, sizeof key->outputs[k].n);
    }
    for (int k = 0; k < key->n_sym; k++) {
        hash = hn_hash_bytes(hash, &key->symbols[k], sizeof key->symbols[k]);
    }
    return hash;
}

static bool is_equal(const hn_tape_key *a, const hn_tape_key *b) {
    if (a->n_out != b->n_out || a->n_sym != b->n_sym) {
        return false;
    }
    for (int k = 0; k < a->n_out; k++) { // coefficients by their bits: 0 and -0 are two constants
        const hn_ex *x = &a->outputs[k], *y = &b->outputs[k];
        if (x->n != y->n || memcmp(&x->c, &y->c, sizeof x->c) != 0) {
            return false;
        }
    }
    for (int k = 0; k < a->n_sym; k++) {
        if (a->symbols[k] != b->symbols[k]) {
            return false;
        }
    }
    return true;
}

/// A tape of its own with the code of another.
static hn_tape *share(const hn_tape *tape) {
    hn_tape *own = malloc(sizeof *own);
    if (own) {
        *own = *tape;
        own->native = NULL;
        atomic_fetch_add(own->sharers, 1);
    }
    return own;
}

hn_status hn_tape_store_find(const hn_tape_store *store, const hn_tape_key *key, hn_tape **out) {
    *out = NULL;
    const uint64_t hash = hash_of(key);
    for (int i = 0; store && i < store->n; i++) {
        const entry *e = &store->entries[i];
        if (e->hash == hash && is_equal(&e->key, key)) {
            *out = share(e->tape);
            return *out ? HN_OK : HN_ERR_MEMORY;
        }
    }
    return HN_OK;
}

static bool grow(hn_tape_store *s) {
    if (s->n < s->cap) {
        return true;
    }
    const int cap = s->cap ? 2 * s->cap : 16;
    entry *entries = realloc(s->entries, (size_t)cap * sizeof *entries);
    if (entries) {
        s->entries = entries;
        s->cap = cap;
    }
    return entries != NULL;
}

static void reset_entry(entry *e) {
    free((void *)e->key.outputs);
    free((void *)e->key.symbols);
    hn_tape_free(e->tape);
}

hn_status hn_tape_store_keep(hn_tape_store **store, const hn_tape_key *key, hn_tape *tape) {
    *store = *store ? *store : calloc(1, sizeof **store);
    if (!*store || !grow(*store)) {
        return HN_ERR_MEMORY;
    }

    // copies of the key, and a share of the code
    hn_ex *outputs = malloc(((size_t)key->n_out + 1) * sizeof *outputs);
    int *symbols = malloc(((size_t)key->n_sym + 1) * sizeof *symbols);
    entry e = {.hash = hash_of(key),
               .key = {outputs, key->n_out, symbols, key->n_sym},
               .tape = outputs && symbols ? share(tape) : NULL};
    if (!e.tape) {
        reset_entry(&e);
        return HN_ERR_MEMORY;
    }
    for (int k = 0; k < key->n_out; k++) {
        outputs[k] = key->outputs[k];
    }
    for (int k = 0; k < key->n_sym; k++) {
        symbols[k] = key->symbols[k];
    }
    (*store)->entries[(*store)->n++] = e;
    return HN_OK;
}

void hn_tape_store_free(hn_tape_store *store) {
    for (int i = 0; store && i < store->n; i++) {
        reset_entry(&store->entries[i]);
    }
    if (store) {
        free(store->entries);
    }
    free(store);
}
