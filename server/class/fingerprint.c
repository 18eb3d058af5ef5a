// SPDX-License-Identifier: GPL-3.0-or-later
#include "class/fingerprint.h"

#include "base/hash.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_NAMES = 1024, MOST_GIVEN = 2048, HEAVIEST = 255, DIGITS = 10 };
/// A statement with fewer known words says nothing about who wrote it.
static const int FEWEST_KNOWN = 2;
/// Weight below which programs are not compared: two or three formulas that everyone finds.
static const int LEAST_WEIGHT = 40;

struct hn_given_source {
    hn_source_style style;
    int n_names, n_statements;
    uint64_t name[MOST_NAMES];
    uint32_t statement[MOST_GIVEN];
};

/// A reading of a program.
typedef struct reader {
    const hn_given_source *given; ///< whose names are known
    uint64_t sum;                 ///< of the words of the statement that is read, in any order
    int known, depth;             ///< known words in it; brackets that are open
    void (*end)(void *user, uint32_t hash, int known);
    void *user;
} reader;

static bool is_known(const hn_given_source *given, uint64_t name) {
    for (int i = 0; i < given->n_names; i++) {
        if (given->name[i] == name) {
            return true;
        }
    }
    return false;
}

/// A word of a declaration, which says nothing.
static bool is_type(const char *at, size_t n) {
    static const char *const types[] = {"const",    "double", "int",   "float", "static",
                                        "final",    "var",    "let",   "long",  "auto",
                                        "unsigned", "size_t", "local", "void"};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        if (strlen(types[i]) == n && strncmp(at, types[i], n) == 0) {
            return true;
        }
    }
    return false;
}

static void add_word(reader *r, uint64_t word, bool known) {
    r->sum += hn_hash_mix(hn_hash_word(HN_HASH_START, word));
    r->known += known;
}

static void end_statement(reader *r) {
    if (r->known >= FEWEST_KNOWN) {
        r->end(r->user, (uint32_t)(hn_hash_mix(r->sum) >> 32), r->known);
    }
    r->sum = 0;
    r->known = 0;
}

/// A known name or a function is itself; all others are one.
static const char *read_name(reader *r, const char *at) {
    size_t n = 0;
    while (hn_source_continues_name(at[n])) {
        n++;
    }
    const uint64_t name = hn_hash_bytes(HN_HASH_START, at, n);
    const bool known = hn_source_is_function(at, n) || is_known(r->given, name);
    if (!is_type(at, n)) {
        add_word(r, known ? name : 0, known);
    }
    return at + n;
}

/// 3, 3.0 and 3e0 are one number.
static const char *read_number(reader *r, const char *at) {
    char *end;
    const double value = strtod(at, &end);
    add_word(r, hn_hash_double(HN_HASH_START, value), true);
    return end > at ? end : at + 1;
}

static void read_sign(reader *r, char c) {
    const bool opens = c == '(' || c == '[', closes = c == ')' || c == ']';
    r->depth += opens - closes;
    const bool line = c == '\n' && hn_source_is_by_lines(r->given->style);
    if (c == ';' || c == '{' || c == '}' || ((line || c == ',') && r->depth <= 0)) {
        r->depth = r->depth < 0 || c != ',' ? 0 : r->depth;
        end_statement(r);
    } else if (!isspace((unsigned char)c) && !strchr("(),\\", c)) {
        add_word(r, (uint64_t)c << 56, false);
    }
}

static void read_source(reader *r, const char *text) {
    for (const char *at = text; *at;) {
        const char *skipped = hn_source_skip_comment(r->given->style, at);
        skipped = skipped ? skipped : hn_source_skip_quotes(text, at);
        if (skipped) {
            at = skipped;
        } else if (hn_source_begins_name(*at)) {
            at = read_name(r, at);
        } else if (isdigit((unsigned char)*at) || (*at == '.' && isdigit((unsigned char)at[1]))) {
            at = read_number(r, at);
        } else if (*at == '\\' && at[1] == '\n') {
            at += 2; // the statement goes on
        } else {
            read_sign(r, *at++);
        }
    }
    end_statement(r);
}

// ---- the given program ----

/// The names before the parts to fill in: what the scene and the program call by them.
static void keep_names(hn_given_source *given, const char *text) {
    const char *end = strstr(text, "YOUR PART");
    for (const char *at = text; *at && (!end || at < end);) {
        const char *skipped = hn_source_skip_comment(given->style, at);
        skipped = skipped ? skipped : hn_source_skip_quotes(text, at);
        size_t n = 0;
        while (!skipped && hn_source_continues_name(at[n])) {
            n++;
        }
        const uint64_t name = hn_hash_bytes(HN_HASH_START, at, n);
        if (n > 0 && given->n_names < MOST_NAMES && !is_known(given, name)) {
            given->name[given->n_names++] = name;
        }
        at = skipped ? skipped : at + (n > 0 ? n : 1);
    }
}

static void keep_given(void *user, uint32_t hash, int known) {
    hn_given_source *given = user;
    (void)known;
    if (given->n_statements < MOST_GIVEN) {
        given->statement[given->n_statements++] = hash;
    }
}

hn_given_source *hn_given_source_read(const char *text, hn_source_style style) {
    hn_given_source *given = calloc(1, sizeof *given);
    if (given) {
        given->style = style;
        keep_names(given, text);
        reader r = {.given = given, .end = keep_given, .user = given};
        read_source(&r, text);
    }
    return given;
}

void hn_given_source_free(hn_given_source *given) {
    free(given);
}

// ---- the statements of one's own ----

typedef struct keeping {
    hn_fingerprint *f;
    const hn_given_source *given;
} keeping;

/// Keeps a statement at its place; where the list is full the last one goes.
static void keep_own(void *user, uint32_t hash, int known) {
    const keeping *k = user;
    hn_fingerprint *f = k->f;
    for (int i = 0; i < k->given->n_statements; i++) {
        if (k->given->statement[i] == hash) {
            return;
        }
    }
    f->is_sample |= f->n == HN_FINGERPRINT_MOST;
    if (f->n == HN_FINGERPRINT_MOST && hash >= f->statement[f->n - 1].hash) {
        return;
    }
    int i = f->n < HN_FINGERPRINT_MOST ? f->n++ : f->n - 1;
    for (; i > 0 && f->statement[i - 1].hash > hash; i--) {
        f->statement[i] = f->statement[i - 1];
    }
    f->statement[i].hash = hash;
    f->statement[i].weight = (uint8_t)(known < HEAVIEST ? known : HEAVIEST);
}

void hn_fingerprint_read(hn_fingerprint *f, const char *text, const hn_given_source *given) {
    keeping k = {f, given};
    reader r = {.given = given, .end = keep_own, .user = &k};
    *f = (hn_fingerprint){0};
    read_source(&r, text);
}

void hn_fingerprint_put(hn_strbuf *b, const hn_fingerprint *f) {
    for (int i = 0; i < f->n; i++) {
        hn_strbuf_printf(b, "%08x%02x", (unsigned)f->statement[i].hash,
                         (unsigned)f->statement[i].weight);
    }
    hn_strbuf_add(b, f->is_sample ? "+" : "");
}

void hn_fingerprint_parse(hn_fingerprint *f, const char *text) {
    *f = (hn_fingerprint){0};
    unsigned hash, weight;
    while (f->n < HN_FINGERPRINT_MOST && strspn(text, "0123456789abcdef") >= DIGITS &&
           sscanf(text, "%8x%2x", &hash, &weight) == 2) {
        f->statement[f->n].hash = hash;
        f->statement[f->n++].weight = (uint8_t)weight;
        text += DIGITS;
    }
    f->is_sample = *text == '+';
    if (text[f->is_sample] != '\0') {
        *f = (hn_fingerprint){0};
    }
}

double hn_fingerprint_share(const hn_fingerprint *a, const hn_fingerprint *b) {
    // samples are compared as far as both reach
    uint32_t last = UINT32_MAX;
    last = a->is_sample ? a->statement[a->n - 1].hash : last;
    last = b->is_sample && b->statement[b->n - 1].hash < last ? b->statement[b->n - 1].hash : last;
    int i = 0, k = 0, own = 0, other = 0, both = 0;
    while ((i < a->n && a->statement[i].hash <= last) ||
           (k < b->n && b->statement[k].hash <= last)) {
        const uint64_t x = i < a->n ? a->statement[i].hash : UINT64_MAX;
        const uint64_t y = k < b->n ? b->statement[k].hash : UINT64_MAX;
        const int weight = x <= y ? a->statement[i].weight : b->statement[k].weight;
        both += x == y ? weight : 0;
        own += x <= y ? weight : 0;
        other += y <= x ? weight : 0;
        i += x <= y;
        k += y <= x;
    }
    const int least = own < other ? own : other;
    return least >= LEAST_WEIGHT ? (double)both / least : 0;
}
