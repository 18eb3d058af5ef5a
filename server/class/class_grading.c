// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // pipe2
#include "class/class_grading.h"

#include "base/clock.h"
#include "base/hash.h"
#include "build.h"
#include "class/class_line.h"
#include "class/likeness.h"
#include "grade/grade.h"
#include "grade/rubric.h"
#include "grade/submission.h"
#include "grade/variant.h"

#include <cjson/cJSON.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

enum {
    MOST_JOBS = 64,
    TICK = 100,       ///< [ms] between two looks at the clock
    MOST_ATTEMPTS = 3 ///< workers that are offered one submission
};

typedef struct worker {
    pid_t pid;
    int ask, answer; ///< indices go out, lines come back
    int index;       ///< of the submission under way; -1: idle
    double since;
    hn_strbuf text;
} worker;

typedef struct grading {
    const hn_roster *roster;
    const hn_exercise *exercise;
    const hn_class_opts *opts;
    hn_class_result *out;
    uint64_t *key; ///< of each submission: what its line depends on
    FILE *journal;
    worker workers[MOST_JOBS];
    int n_workers, next, done;
} grading;

// ---- one line ----

/// Returns whether a submission belongs to this shard.
static bool is_mine(const grading *g, int i) {
    const hn_class_shard *shard = &g->opts->shard;
    return shard->n == 0 || i % shard->n == shard->i - 1;
}

static hn_roster_kind kinds_of(const grading *g) {
    return g->opts->programs ? HN_ROSTER_PROGRAMS : HN_ROSTER_ANSWERS;
}

static uint64_t seed_of(const grading *g, const hn_roster_entry *e) {
    return g->opts->programs          ? 0
           : g->opts->seed            ? g->opts->seed
           : g->exercise->n_parts > 0 ? hn_variant_seed(g->exercise, e->student)
                                      : 0;
}

/// Returns how many submissions carry the name of submission i; the roster is sorted by name.
static int count_name(const hn_roster *r, int i) {
    int n = 1;
    for (int k = i; k > 0 && strcmp(r->entry[k - 1].student, r->entry[i].student) == 0; k--) {
        n++;
    }
    for (int k = i; k + 1 < r->n && strcmp(r->entry[k + 1].student, r->entry[i].student) == 0;
         k++) {
        n++;
    }
    return n;
}

/// Continues a hash with what every line depends on: the exercise and the rubric.
static uint64_t hash_rules(const grading *g, uint64_t hash) {
    const uint64_t rubric = hn_rubric_hash(g->exercise->rubric);
    hash = hn_hash_bytes(hash, &g->exercise->hash, sizeof g->exercise->hash);
    return hn_hash_bytes(hash, &rubric, sizeof rubric);
}

/// Returns what the line of a submission depends on: its text or why there is none, the exercise,
/// the seed, others of its name, and this build.
static uint64_t calc_key(const grading *g, const hn_roster_entry *e) {
    hn_strbuf text;
    char file[HN_ROSTER_PATH];
    hn_diag diag = {0};
    hn_strbuf_init(&text);
    const hn_status status = hn_roster_load(e, kinds_of(g), &text, file, &diag);
    uint64_t hash = hash_rules(g, hn_hash_text(HN_HASH_START, hn_build_name()));
    const uint64_t seed = seed_of(g, e);
    hash = hn_hash_bytes(hash, &seed, sizeof seed);
    hash = hn_hash_text(hash, e->student);
    const int same = count_name(g->roster, (int)(e - g->roster->entry));
    hash = hn_hash_bytes(hash, &same, sizeof same);
    hash = status == HN_OK ? hn_hash_bytes(hash, hn_strbuf_text(&text), text.n)
                           : hn_hash_text(hash, diag.message);
    hn_strbuf_reset(&text);
    return hn_hash_mix(hash);
}

static void begin_line(const grading *g, int i, hn_strbuf *b, const char *status) {
    char hex[17];
    hn_hash_hex(g->key[i], hex);
    hn_json_object(b);
    hn_json_put_string(b, "student", g->roster->entry[i].student);
    hn_json_put_string(b, "status", status);
    hn_json_put_string(b, "key", hex);
    if (g->opts->shard.n > 0) {
        // its place in the roster, by which merge puts together parts that have the same rules
        const uint64_t seed = g->opts->seed;
        const uint64_t marking = hn_hash_bytes(hash_rules(g, HN_HASH_START), &seed, sizeof seed);
        hn_json_put_int(b, "place", i);
        hn_json_put_int(b, "of", g->roster->n);
        hn_json_put_string(b, "exercise", hn_exercise_id(g->exercise));
        hn_hash_hex(hn_hash_mix(marking), hex);
        hn_json_put_string(b, "marking", hex);
    }
    const int same = count_name(g->roster, i);
    if (same > 1) {
        char remark[80];
        snprintf(remark, sizeof remark, "%d submissions have this name; keep one", same);
        hn_json_put_string(b, "remark", remark);
    }
}

/// A line without a score of its own still says what could be had.
static void put_zero(const grading *g, hn_strbuf *b, const char *reason) {
    hn_json_put_number(b, "score", 0);
    hn_json_put_number(b, "max_score", hn_exercise_points(g->exercise));
    hn_json_put_string(b, "reason", reason);
}

/// Writes what a submission says, and its shape, by which copies are found.
static void put_likeness(const grading *g, hn_strbuf *b, const char *text, const char *file) {
    const bool is_program = g->opts->programs != NULL;
    cJSON *submission = is_program ? NULL : cJSON_Parse(text);
    char texts[17], shape[17];
    hn_hash_hex(is_program ? hn_likeness_program_texts(text, hn_source_style_of(file))
                           : hn_likeness_texts(submission),
                texts);
    hn_hash_hex(is_program ? hn_likeness_program_shape(text, hn_source_style_of(file))
                           : hn_likeness_shape(submission),
                shape);
    cJSON_Delete(submission);
    hn_json_put_string(b, "texts", texts);
    hn_json_put_string(b, "shape", shape);

    // the statements of its own, by which copies with an added one are found
    const hn_given_source *given =
        g->opts->blanks ? hn_blank_programs_of(g->opts->blanks, file) : NULL;
    if (given) {
        hn_fingerprint own;
        hn_strbuf list;
        hn_strbuf_init(&list);
        hn_fingerprint_read(&own, text, given);
        hn_fingerprint_put(&list, &own);
        hn_json_put_string(b, "statements", hn_strbuf_text(&list));
        b->failed |= list.failed;
        hn_strbuf_reset(&list);
    }
}

/// The wrong entries by which copies of a part are found: "b: other 0123456789abcdef".
static void put_alike(hn_strbuf *b, const hn_verdict *v) {
    hn_json_key(b, "alike");
    hn_json_array(b);
    for (int k = 0; k < v->n_entries; k++) {
        const hn_entry_verdict *e = &v->entry[k];
        if (!e->right && e->likeness) {
            char hex[17], what[96];
            hn_hash_hex(e->likeness, hex);
            snprintf(what, sizeof what, "%s: %.32s %s", e->name, e->mistake, hex);
            hn_json_string(b, what);
        }
    }
    hn_json_end_array(b);
}

static void put_graded(const grading *g, hn_strbuf *b, const hn_verdict *v, const char *text,
                       const char *file) {
    hn_json_put_number(b, "score", v->score);
    hn_json_put_number(b, "max_score", v->max_score);
    hn_json_put_string(b, "summary", v->summary);
    put_likeness(g, b, text, file);
    put_alike(b, v);
    hn_class_line_put_mistakes(b, v);
}

/// The line of submission i.
static void grade_one(const grading *g, int i, hn_strbuf *b) {
    const hn_roster_entry *e = &g->roster->entry[i];
    hn_strbuf text;
    char file[HN_ROSTER_PATH];
    hn_diag diag = {0};
    hn_verdict *v = calloc(1, sizeof *v);
    hn_strbuf_init(&text);
    hn_status status = v ? hn_roster_load(e, kinds_of(g), &text, file, &diag) : HN_ERR_MEMORY;
    const bool there = status == HN_OK;
    if (status == HN_OK) {
        status = g->opts->programs
                     ? hn_filled_program_grade_text(g->opts->programs, file, hn_strbuf_text(&text),
                                                    text.n, v)
                     : hn_grade_json(g->exercise, hn_strbuf_text(&text), text.n, seed_of(g, e), v);
    }

    // the name chooses no variant of an exercise without numbers, but it is still compared
    if (there && status == HN_OK && !g->opts->programs && g->exercise->n_parts == 0 &&
        !g->opts->seed) {
        hn_submission_check_student(v, e->student);
    }

    // graded, not gradable by its own fault, or the grader's fault
    const bool failed = there ? status != HN_OK : !v;
    const bool graded = !failed && there && v->kind == HN_VERDICT_GRADED;
    begin_line(g, i, b, failed ? "failed" : graded ? "graded" : "ungradable");
    hn_json_put_string(b, "file", v ? file : "");
    if (graded) {
        put_graded(g, b, v, hn_strbuf_text(&text), file);
    } else {
        char why[2 * HN_GRADE_TEXT + 2] = "";
        if (failed) {
            const bool named = v && v->reason[0];
            snprintf(why, sizeof why, "%s%s", named ? HN_CLASS_EXERCISE_FAULT : "",
                     named ? v->reason : hn_status_text(status));
        } else if (there) { // the hint of a submission says what to do, or why
            snprintf(why, sizeof why, "%s%s%s", v->reason, v->hint[0] ? "; " : "", v->hint);
        }
        put_zero(g, b, failed || there ? why : diag.message);
    }
    hn_class_line_put_check(b);
    hn_json_end_object(b);
    hn_strbuf_add(b, "\n");
    hn_strbuf_reset(&text);
    free(v);
}

// ---- workers ----

/// In the child: answers indices with lines until there are no more.
_Noreturn static void work(const grading *g, int ask, int answer) {
    int i;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    signal(SIGINT, SIG_IGN); // Ctrl-C is the parent's to answer
    while (read(ask, &i, sizeof i) == (ssize_t)sizeof i) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        grade_one(g, i, &b);
        const char *text = hn_strbuf_text(&b);
        for (size_t sent = 0; sent < b.n;) {
            const ssize_t n = write(answer, text + sent, b.n - sent);
            if (n <= 0) {
                _exit(1);
            }
            sent += (size_t)n;
        }
        hn_strbuf_reset(&b);
    }
    _exit(0);
}

static hn_status start_worker(grading *g, worker *w, hn_diag *diag) {
    int ask[2], answer[2];

    // a pipe each way
    if (pipe2(ask, O_CLOEXEC) != 0 || pipe2(answer, O_CLOEXEC) != 0) {
        return hn_diag_set(diag, HN_ERR_IO, NULL, NULL, "no pipe for a worker: %s",
                           strerror(errno));
    }

    // the child grades until its pipe ends
    fflush(NULL);
    *w = (worker){.pid = fork(), .ask = ask[1], .answer = answer[0], .index = -1};
    hn_strbuf_init(&w->text);
    if (w->pid == 0) {
        close(ask[1]);
        close(answer[0]);
        // the pipes of the others: their ends would never come
        for (int k = 0; k < g->n_workers; k++) {
            if (&g->workers[k] != w && g->workers[k].pid > 0) {
                close(g->workers[k].ask);
                close(g->workers[k].answer);
            }
        }
        work(g, ask[0], answer[1]);
    }

    close(ask[0]);
    close(answer[1]);
    return w->pid > 0 ? HN_OK
                      : hn_diag_set(diag, HN_ERR_IO, NULL, NULL, "no process for a worker: %s",
                                    strerror(errno));
}

static void end_worker(worker *w, bool kill_it) {
    if (w->pid <= 0) {
        return;
    }
    close(w->ask);
    if (kill_it) {
        kill(w->pid, SIGKILL);
    }
    close(w->answer);
    waitpid(w->pid, NULL, 0);
    hn_strbuf_reset(&w->text);
    w->pid = 0;
}

// ---- lines that are done ----

/// Call it right behind the failure, while errno says why.
static hn_status say_journal_failed(const grading *g, hn_diag *diag) {
    return hn_diag_set(diag, HN_ERR_IO, NULL, "make room, then give the same command: it goes on",
                       "'%.200s' cannot be written: %s", g->opts->journal, strerror(errno));
}

static hn_status keep_line(grading *g, int i, const char *line, bool told, hn_diag *diag) {
    g->out->line[i] = strdup(line);
    if (!g->out->line[i]) {
        return HN_ERR_MEMORY;
    }
    g->done++;
    if (told) {
        g->out->graded++;
        if (g->journal && (fprintf(g->journal, "%s\n", line) < 0 || fflush(g->journal) != 0)) {
            return say_journal_failed(g, diag);
        }
        if (g->opts->tell) {
            g->opts->tell(g->opts->user, line);
        }
    }
    return HN_OK;
}

/// A line for a submission that no worker graded.
static hn_status keep_loss(grading *g, int i, const char *reason, hn_diag *diag) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    begin_line(g, i, &b, "failed");
    put_zero(g, &b, reason);
    hn_json_end_object(&b);
    const hn_status status = keep_line(g, i, hn_strbuf_text(&b), true, diag);
    hn_strbuf_reset(&b);
    return status;
}

/// Reads what a worker has to say; false: it has ended.
static bool read_worker(worker *w) {
    char piece[8192];
    const ssize_t n = read(w->answer, piece, sizeof piece);
    if (n > 0) {
        hn_strbuf_add_n(&w->text, piece, (size_t)n);
    }
    return n > 0 || (n < 0 && errno == EINTR);
}

static hn_status look_at(grading *g, worker *w, bool ready, hn_diag *diag) {
    const bool alive = !ready || read_worker(w);

    // a whole line is a verdict
    if (w->text.n > 0 && w->text.text[w->text.n - 1] == '\n') {
        w->text.text[w->text.n - 1] = '\0';
        const hn_status status = keep_line(g, w->index, hn_strbuf_text(&w->text), true, diag);
        hn_strbuf_clear(&w->text);
        w->index = -1;
        return status;
    }

    // a worker that ended or takes too long is replaced; its submission counts as lost
    const bool late = w->index >= 0 && hn_clock_wall() - w->since > g->opts->time_limit;
    if (!alive || late) {
        char reason[80];
        snprintf(reason, sizeof reason,
                 late ? "grading took longer than %g s" : "the grader ended while it graded this",
                 g->opts->time_limit);
        const hn_status status = w->index >= 0 ? keep_loss(g, w->index, reason, diag) : HN_OK;
        end_worker(w, true);
        HN_TRY(status);
        return start_worker(g, w, diag);
    }
    return HN_OK;
}

/// Hands submission i to a worker. A worker that takes no work has ended and is replaced; a
/// submission that no worker takes gets a line that says so.
static hn_status give_to(grading *g, worker *w, int i, hn_diag *diag) {
    for (int attempt = 0; attempt < MOST_ATTEMPTS; attempt++) {
        ssize_t sent;
        do {
            sent = write(w->ask, &i, sizeof i);
        } while (sent < 0 && errno == EINTR);
        if (sent == (ssize_t)sizeof i) {
            w->index = i;
            w->since = hn_clock_wall();
            return HN_OK;
        }
        end_worker(w, true);
        HN_TRY(start_worker(g, w, diag));
    }
    return keep_loss(g, i, "no process took this submission; grade it again", diag);
}

static hn_status give_work(grading *g, hn_diag *diag) {
    for (int k = 0; k < g->n_workers; k++) {
        worker *w = &g->workers[k];
        while (w->index < 0 && g->next < g->roster->n) {
            const int i = g->next++;
            if (!g->out->line[i] && is_mine(g, i)) {
                HN_TRY(give_to(g, w, i, diag));
            }
        }
    }
    return HN_OK;
}

static hn_status run(grading *g, hn_diag *diag) {
    hn_status status = HN_OK;
    while (status == HN_OK && g->done < g->roster->n - g->out->others) {
        struct pollfd wait[MOST_JOBS];
        if (g->opts->stop && g->opts->stop(g->opts->user)) {
            return HN_ERR_STOPPED;
        }
        HN_TRY(give_work(g, diag));
        for (int k = 0; k < g->n_workers; k++) {
            wait[k] = (struct pollfd){.fd = g->workers[k].answer, .events = POLLIN};
        }
        poll(wait, (nfds_t)g->n_workers, TICK);
        for (int k = 0; status == HN_OK && k < g->n_workers; k++) {
            status = look_at(g, &g->workers[k], wait[k].revents != 0, diag);
        }
    }
    return status;
}

// ---- the journal ----

static int find_key(const grading *g, const char *student, const char *hex) {
    for (int i = 0; i < g->roster->n; i++) {
        char own[17];
        hn_hash_hex(g->key[i], own);
        if (is_mine(g, i) && strcmp(own, hex) == 0 &&
            strcmp(g->roster->entry[i].student, student) == 0 && !g->out->line[i]) {
            return i;
        }
    }
    return -1;
}

/// Returns whether a line has the place that submission i has now: a run of the whole class gives
/// it none.
static bool is_in_place(const grading *g, const cJSON *line, int i) {
    const cJSON *place = cJSON_GetObjectItem(line, "place"), *of = cJSON_GetObjectItem(line, "of");
    return g->opts->shard.n > 0 ? cJSON_IsNumber(place) && place->valueint == i &&
                                      cJSON_IsNumber(of) && of->valueint == g->roster->n
                                : !place;
}

/// Takes the lines of an earlier run that still hold; a line that was cut off by a kill is dropped.
static hn_status take_lines(grading *g, const char *path, hn_diag *diag) {
    char *line = NULL;
    size_t cap = 0;
    hn_status status = HN_OK;
    FILE *old = fopen(path, "re");
    for (ssize_t n; status == HN_OK && old && (n = getline(&line, &cap, old)) > 0;) {
        cJSON *o = line[n - 1] == '\n' ? cJSON_Parse(line) : NULL;
        const char *student = cJSON_GetStringValue(cJSON_GetObjectItem(o, "student"));
        const char *hex = cJSON_GetStringValue(cJSON_GetObjectItem(o, "key"));
        const char *was = cJSON_GetStringValue(cJSON_GetObjectItem(o, "status"));
        const int i =
            student && hex && was && strcmp(was, "failed") != 0 ? find_key(g, student, hex) : -1;
        if (i >= 0 && is_in_place(g, o, i) && hn_class_line_is_unchanged(line, o)) {
            line[n - 1] = '\0';
            status = keep_line(g, i, line, false, diag);
            g->out->resumed += status == HN_OK;
        }
        cJSON_Delete(o);
    }
    free(line);
    if (old) {
        fclose(old);
    }
    return status;
}

/// Begins the journal anew, with what holds of an interrupted run and of a finished one.
static hn_status open_journal(grading *g, hn_diag *diag) {
    HN_TRY(take_lines(g, g->opts->journal, diag));
    HN_TRY(g->opts->finished ? take_lines(g, g->opts->finished, diag) : HN_OK);
    g->journal = fopen(g->opts->journal, "we");
    if (!g->journal) {
        return say_journal_failed(g, diag);
    }
    for (int i = 0; i < g->roster->n; i++) {
        if (g->out->line[i]) {
            fprintf(g->journal, "%s\n", g->out->line[i]);
        }
    }
    return fflush(g->journal) == 0 ? HN_OK : say_journal_failed(g, diag);
}

hn_status hn_class_grade(const hn_roster *roster, const hn_exercise *exercise,
                         const hn_class_opts *opts, hn_class_result *out, hn_diag *diag) {
    grading g = {.roster = roster, .exercise = exercise, .opts = opts, .out = out};
    const size_t n = (size_t)roster->n;
    *out = (hn_class_result){.n = roster->n, .line = calloc(n + 1, sizeof *out->line)};
    g.key = calloc(n + 1, sizeof *g.key);
    hn_variant_owner *owners = calloc(n + 1, sizeof *owners);
    hn_status status = out->line && g.key && owners ? HN_OK : HN_ERR_MEMORY;

    // whose numbers a wrong answer may be
    hn_exercise with_owners = *exercise;
    for (int i = 0; status == HN_OK && i < roster->n && !opts->seed && !opts->programs; i++) {
        owners[i] = (hn_variant_owner){.seed = seed_of(&g, &roster->entry[i]),
                                       .name = roster->entry[i].student};
        with_owners.n_owners = exercise->n_parts > 0 ? i + 1 : 0;
    }
    with_owners.owners = owners;
    g.exercise = &with_owners;
    for (int i = 0; status == HN_OK && i < roster->n; i++) {
        g.key[i] = calc_key(&g, &roster->entry[i]);
        out->others += !is_mine(&g, i);
    }
    if (status == HN_OK && opts->journal) {
        status = open_journal(&g, diag);
    }

    // no more workers than there is work
    const int left = roster->n - out->others - g.done;
    int jobs = opts->jobs < 1 ? 1 : opts->jobs > MOST_JOBS ? MOST_JOBS : opts->jobs;
    jobs = jobs < left ? jobs : left;
    for (int k = 0; status == HN_OK && k < jobs; k++) {
        status = start_worker(&g, &g.workers[k], diag);
        g.n_workers = k + 1;
    }
    HN_THEN(status, run(&g, diag));
    for (int k = 0; k < g.n_workers; k++) {
        end_worker(&g.workers[k], status != HN_OK);
    }
    if (g.journal) {
        fclose(g.journal);
    }
    free(g.key);
    free(owners);
    return status;
}

void hn_class_result_reset(hn_class_result *r) {
    for (int i = 0; r->line && i < r->n; i++) {
        free(r->line[i]);
    }
    free(r->line);
    *r = (hn_class_result){0};
}
