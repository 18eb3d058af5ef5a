// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/runs/run_store.h"

#include "base/clock.h"
#include "http/ground/jobs.h"
#include "http/ground/stream_socket.h"
#include "http/request/gzip.h"
#include "http/request/request.h"
#include "http/runs/run_folder.h"
#include "session/compare/run_doc.h"

#include <math.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MAX_RUNS = 20000, LOOK_MS = 100, MOST_ZIPPED = 8 << 20 };
static const size_t MAX_BYTES = (size_t)256 << 20; // of documents in memory

struct hn_runs {
    pthread_mutex_t lock;
    pthread_cond_t wake; ///< of the thread that looks at those who wait
    const hn_http_opts *opts;
    const hn_library *lib;
    hn_run_answer answer;
    hn_jobs *jobs;
    hn_kept_run *first;
    hn_run_reader *readers;
    int n, stop, n_waiting;
    size_t bytes;
    pthread_t thread;
    int has_thread;
};

static void compute(void *arg, hn_job_turn *turn);

// ---- one run ----

/// With the lock held: gives up a reference; returns the run when it was the last.
static hn_kept_run *drop(hn_kept_run *run) {
    return --run->refs == 0 ? run : NULL;
}

// ---- the table, with the lock held ----

static hn_kept_run **find_place(hn_runs *all, const char *id) {
    hn_kept_run **place = &all->first;
    while (*place && strcmp((*place)->id, id) != 0) {
        place = &(*place)->next;
    }
    return place;
}

static hn_kept_run *take_out(hn_runs *all, hn_kept_run **place) {
    hn_kept_run *run = *place;
    *place = run->next;
    all->n--;
    all->bytes -= run->phase == HN_RUN_DONE ? run->bytes : 0;
    return run;
}

/// Ends a run that only the table and its thread hold, where nobody waits for it or knows its id.
static void end_unwanted(hn_runs *all, hn_kept_run *run) {
    enum { OF_TABLE_AND_THREAD = 2 };
    if (run->refs != OF_TABLE_AND_THREAD || run->phase >= HN_RUN_DONE || run->is_known ||
        run->waiting) {
        return;
    }
    hn_kept_run **place = find_place(all, run->id);
    if (*place == run) { // it was not deleted
        atomic_store(&run->stop, 1);
        drop(take_out(all, place));
    }
}

void hn_runs_release(hn_runs *all, hn_kept_run *run) {
    pthread_mutex_lock(&all->lock);
    hn_kept_run *dead = drop(run);
    if (!dead) {
        end_unwanted(all, run);
    }
    pthread_mutex_unlock(&all->lock);
    hn_kept_run_free(dead);
}

/// Lets go of the finished run that was longest untouched; 0 when there is none.
static bool forget_oldest(hn_runs *all) {
    hn_kept_run **oldest = NULL;
    for (hn_kept_run **place = &all->first; *place; place = &(*place)->next) {
        if ((*place)->phase == HN_RUN_DONE && (!oldest || (*place)->touched < (*oldest)->touched)) {
            oldest = place;
        }
    }
    if (!oldest) {
        return false;
    }
    hn_kept_run_free(drop(take_out(all, oldest)));
    return true;
}

static void make_room(hn_runs *all) {
    while ((all->n >= MAX_RUNS || all->bytes > MAX_BYTES) && forget_oldest(all)) {}
}

static void put_in(hn_runs *all, hn_kept_run *run) {
    make_room(all);
    run->next = all->first;
    all->first = run;
    all->n++;
    all->bytes += run->bytes;
}

// ---- those who wait ----

/// Takes the requests that wait for a run and are due, or whose clients have gone. With the lock
/// held.
static hn_request *take_waiting(hn_runs *all, hn_kept_run *run, double now, int every_one) {
    hn_request *due = NULL, **place = &run->waiting;
    while (*place) {
        hn_request *r = *place;
        const bool is_due = every_one || now >= r->wait_until;
        if (is_due || hn_request_is_left(r)) {
            run->is_known |= is_due; // it is told the id
            *place = r->next;
            r->next = due;
            due = r;
            run->refs++; // for the answer
            all->n_waiting--;
        } else {
            place = &r->next;
        }
    }
    return due;
}

/// Answers a list of requests, and gives up a reference for each.
static void answer_all(hn_runs *all, hn_kept_run *run, hn_request *due) {
    while (due) {
        hn_request *next = due->next;
        all->answer(due, run);
        hn_reply_compress(due, MOST_ZIPPED);
        hn_request_finish(due);
        hn_runs_release(all, run);
        due = next;
    }
}

void hn_runs_await(hn_runs *all, hn_kept_run *run, hn_request *r, double seconds) {
    pthread_mutex_lock(&all->lock);
    const int waits = run->phase < HN_RUN_DONE && seconds > 0 && !all->stop;
    run->is_known |= !waits;
    if (waits) {
        r->wait_until = hn_clock_wall() + seconds;
        r->next = run->waiting;
        run->waiting = r;
        all->n_waiting++;
        pthread_cond_signal(&all->wake);
    }
    pthread_mutex_unlock(&all->lock);
    if (!waits) {
        all->answer(r, run);
        hn_reply_compress(r, MOST_ZIPPED);
        hn_request_finish(r);
    }
}

/// One run whose waiting requests are due; its reference is held. With the lock held.
static hn_kept_run *find_due(hn_runs *all, double now, hn_request **due) {
    for (hn_kept_run *run = all->first; run; run = run->next) {
        *due = run->waiting ? take_waiting(all, run, now, 0) : NULL;
        if (*due) {
            return run;
        }
    }
    return NULL;
}

/// Wakes the readers of a run, NULL: of all, that are due. With the lock held.
static void wake_readers(hn_runs *all, const hn_kept_run *run, double now) {
    for (hn_run_reader *r = all->readers; r; r = r->next) {
        if (r->waiting && (!run || r->run == run) && now >= r->due) {
            r->waiting = false;
            MHD_resume_connection(r->connection);
        }
    }
}

void hn_runs_add_reader(hn_runs *all, hn_run_reader *reader) {
    pthread_mutex_lock(&all->lock);
    reader->next = all->readers;
    all->readers = reader;
    pthread_mutex_unlock(&all->lock);
}

void hn_runs_remove_reader(hn_runs *all, hn_run_reader *reader) {
    pthread_mutex_lock(&all->lock);
    hn_run_reader **place = &all->readers;
    while (*place != reader) {
        place = &(*place)->next;
    }
    *place = reader->next;
    pthread_mutex_unlock(&all->lock);
}

bool hn_runs_suspend_reader(hn_runs *all, hn_run_reader *reader, double seconds) {
    pthread_mutex_lock(&all->lock);
    const bool waits = reader->run->phase < HN_RUN_DONE && !all->stop;
    if (waits) {
        reader->waiting = true;
        reader->due = hn_clock_wall() + seconds;
        MHD_suspend_connection(reader->connection);
        pthread_cond_signal(&all->wake);
    }
    pthread_mutex_unlock(&all->lock);
    return waits;
}

static void *look(void *arg) {
    hn_runs *all = arg;
    pthread_mutex_lock(&all->lock);
    while (!all->stop) {
        wake_readers(all, NULL, hn_clock_wall());
        if (all->n_waiting == 0 && !all->readers) {
            pthread_cond_wait(&all->wake, &all->lock);
            continue;
        }
        hn_request *due;
        hn_kept_run *run = find_due(all, hn_clock_wall(), &due);
        pthread_mutex_unlock(&all->lock);
        if (run) {
            answer_all(all, run, due);
        } else {
            nanosleep(&(struct timespec){.tv_nsec = LOOK_MS * 1000000L}, NULL);
        }
        pthread_mutex_lock(&all->lock);
    }
    pthread_mutex_unlock(&all->lock);
    return NULL;
}

// ---- computing ----

typedef struct allowance {
    hn_kept_run *run;
    hn_job_turn *turn;
    double cpu_end;
    int method;
    bool used_up;
} allowance;

static int may_go_on(void *user, double share) {
    const allowance *a = user;
    const double done = (a->method + share) / a->run->question.n_methods;
    atomic_store(&a->run->share, done);
    hn_job_report(a->turn, done);
    hn_job_make_way(a->turn);
    return !atomic_load(&a->run->stop) && hn_clock_thread() < a->cpu_end;
}

/// The document of one method.
static hn_status run_method(const hn_runs *all, hn_kept_run *run, const hn_model *model, int method,
                            hn_job_turn *turn) {
    const hn_run_question *q = &run->question;
    allowance a = {.run = run,
                   .turn = turn,
                   .method = method,
                   .cpu_end = hn_clock_thread() + all->opts->max_run_cpu / q->n_methods};
    const hn_run_request request = {.method = q->methods[method],
                                    .time = q->time,
                                    .at = q->at,
                                    .n_at = q->n_at,
                                    .every = q->every,
                                    .max_samples = all->opts->max_samples,
                                    .max_numbers = all->opts->max_numbers / q->n_methods,
                                    .reactions = q->reactions,
                                    .raw_lambda = q->raw_lambda,
                                    .progress = may_go_on,
                                    .stop_reason = "the computing time of one request is used up",
                                    .user = &a};

    // a run that ended early is an answer too
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_status ended = HN_OK;
    hn_status status = hn_model_run_json(&b, model, &request, &ended, &run->diags);
    if (status == HN_OK && !hn_kept_run_add_document(run, &b)) {
        status = HN_ERR_MEMORY;
    }
    run->is_cut |= ended == HN_ERR_STOPPED;
    hn_strbuf_reset(&b);
    return status;
}

/// Returns whether the equations, of the scene and of the methods, take too long or are no longer
/// wanted.
static bool must_end(void *user) {
    allowance *a = user;
    hn_job_make_way(a->turn);
    a->used_up |= hn_clock_thread() > a->cpu_end;
    return a->used_up || atomic_load(&a->run->stop);
}

static hn_status run_all(const hn_runs *all, hn_kept_run *run, hn_job_turn *turn) {
    // as much time for equations as for all steps
    hn_model *model = NULL;
    const double seconds = all->opts->max_run_cpu;
    allowance a = {.run = run, .turn = turn, .cpu_end = hn_clock_thread() + seconds};
    hn_status status = hn_scene_request_load(&run->question.scene, all->lib, 0,
                                             (hn_interrupt){must_end, &a}, &model, &run->diags);
    a.cpu_end += seconds;
    for (int i = 0; i < run->question.n_methods && status == HN_OK; i++) {
        status = run_method(all, run, model, i, turn);
    }
    hn_model_free(model);
    if (status != HN_OK && a.used_up) {
        run->diags.n = 0;
        status = hn_diags_add(
            &run->diags, HN_ERR_LIMIT, "/scene", "take fewer bodies, or shorter chains",
            "the equations of this scene take more than %g s of computing", seconds);
    }
    return status;
}

/// On a thread of the pool.
static void compute(void *arg, hn_job_turn *turn) {
    hn_kept_run *run = arg;
    hn_runs *all = run->question.store;
    pthread_mutex_lock(&all->lock);
    run->phase = HN_RUN_COMPUTES;
    pthread_mutex_unlock(&all->lock);
    run->refused = atomic_load(&run->stop) ? HN_ERR_STOPPED : run_all(all, run, turn);

    // a run that was stopped is not the answer to its question
    const int stopped = atomic_load(&run->stop);
    if (stopped) {
        run->refused = HN_ERR_STOPPED;
    }
    const bool is_kept = run->refused == HN_OK && !run->is_cut;
    if (is_kept) {
        hn_run_folder_keep(all->opts->runs_folder, run);
    }
    pthread_mutex_lock(&all->lock);
    run->phase = run->refused == HN_OK ? HN_RUN_DONE : HN_RUN_REFUSED;
    hn_kept_run **place = find_place(all, run->id);
    const int known = *place == run;
    if (known && run->phase == HN_RUN_DONE) {
        run->touched = hn_clock_wall(); // it makes room for itself last
        all->bytes += run->bytes;
        make_room(all);
    } else if (known) {
        run->bytes = 0;
        drop(take_out(all, place));
    }
    hn_request *due = take_waiting(all, run, 0, 1);
    wake_readers(all, run, HUGE_VAL);
    if (is_kept && !*find_place(all, run->id)) { // it was deleted while its file was written
        hn_run_folder_delete(all->opts->runs_folder, run->id);
    }
    pthread_mutex_unlock(&all->lock);
    answer_all(all, run, due);
    hn_runs_release(all, run);
}

// ---- the store ----

hn_runs *hn_runs_create(const hn_http_opts *opts, const hn_library *lib, hn_run_answer answer) {
    hn_runs *all = calloc(1, sizeof *all);
    if (!all) {
        return NULL;
    }
    pthread_mutex_init(&all->lock, NULL);
    pthread_cond_init(&all->wake, NULL);
    all->opts = opts;
    all->lib = lib;
    all->answer = answer;
    hn_jobs_opts pool = hn_http_opts_pool(opts);
    pool.reports = true;
    all->jobs = hn_jobs_create(&pool, compute);
    all->has_thread = all->jobs && pthread_create(&all->thread, NULL, look, all) == 0;
    if (!all->has_thread) {
        hn_runs_free(all);
        return NULL;
    }
    return all;
}

void hn_runs_tell_end(hn_runs *all) {
    pthread_mutex_lock(&all->lock);
    all->stop = 1;
    for (hn_kept_run *run = all->first; run; run = run->next) {
        atomic_store(&run->stop, 1);
    }
    for (const hn_run_reader *r = all->readers; r; r = r->next) {
        hn_stream_socket_end(r->fd);
    }
    pthread_cond_signal(&all->wake);
    pthread_mutex_unlock(&all->lock);
}

bool hn_runs_is_ending(hn_runs *all) {
    pthread_mutex_lock(&all->lock);
    const bool is_ending = all->stop;
    pthread_mutex_unlock(&all->lock);
    return is_ending;
}

void hn_runs_stop(hn_runs *all) {
    if (!all) {
        return;
    }
    hn_runs_tell_end(all);

    // the threads answer those who wait
    hn_jobs_stop(all->jobs);
    pthread_mutex_lock(&all->lock);
    wake_readers(all, NULL, HUGE_VAL);
    pthread_mutex_unlock(&all->lock);
    if (all->has_thread) {
        pthread_join(all->thread, NULL);
        all->has_thread = 0;
    }
}

void hn_runs_free(hn_runs *all) {
    if (all) {
        hn_runs_stop(all);
        while (all->first) {
            hn_kept_run_free(drop(take_out(all, &all->first)));
        }
        hn_jobs_free(all->jobs);
        pthread_cond_destroy(&all->wake);
        pthread_mutex_destroy(&all->lock);
        free(all);
    }
}

/// In memory. With the lock held; returns a reference.
static hn_kept_run *find_here(hn_runs *all, const char *id) {
    hn_kept_run *run = *find_place(all, id);
    if (run) {
        run->refs++;
        run->touched = hn_clock_wall();
    }
    return run;
}

/// In memory or in the folder. Returns a reference.
static hn_kept_run *find(hn_runs *all, const char *id) {
    pthread_mutex_lock(&all->lock);
    hn_kept_run *run = find_here(all, id);
    pthread_mutex_unlock(&all->lock);
    if (run || !all->opts->runs_folder) {
        return run;
    }

    // another thread may have read the same file meanwhile
    hn_kept_run *read = hn_run_folder_read(all->opts->runs_folder, id);
    pthread_mutex_lock(&all->lock);
    run = find_here(all, id);
    if (!run && read) {
        put_in(all, read);
        run = find_here(all, id);
        read = NULL;
    }
    pthread_mutex_unlock(&all->lock);
    hn_kept_run_free(read);
    return run;
}

hn_kept_run *hn_runs_find(hn_runs *all, const char *id) {
    hn_kept_run *run = find(all, id);
    if (run) {
        pthread_mutex_lock(&all->lock);
        run->is_known = true;
        pthread_mutex_unlock(&all->lock);
    }
    return run;
}

/// The first letters of an id, a hash, as a number.
static uint64_t key_of(const char *id) {
    uint64_t key = 0;
    memcpy(&key, id, sizeof key);
    return key;
}

/// Puts a new run into the table and the queue. With the lock held.
static hn_status begin_new(hn_runs *all, hn_run_question *question, hn_client client,
                           hn_kept_run **out) {
    hn_kept_run *run = hn_kept_run_create(question->id, client);
    if (!run) {
        return HN_ERR_MEMORY;
    }
    hn_strbuf request;
    hn_strbuf_init(&request);
    hn_run_question_json(&request, question);
    run->request = hn_strbuf_take(&request);
    if (!run->request) {
        hn_kept_run_free(run);
        return HN_ERR_MEMORY;
    }
    run->question = *question;
    run->question.store = all;
    run->refs = 3; // the table, the thread, the caller
    if (!hn_jobs_push(all->jobs, run, client, key_of(run->id))) {
        free(run->request);
        free(run);
        return HN_ERR_LIMIT;
    }
    *question = (hn_run_question){0};
    put_in(all, run);
    *out = run;
    return HN_OK;
}

hn_status hn_runs_begin(hn_runs *all, hn_run_question *question, hn_client client,
                        hn_kept_run **out, int *begun) {
    *begun = 0;
    *out = find(all, question->id);
    if (*out && hn_runs_phase(all, *out) == HN_RUN_DONE && (*out)->is_cut) {
        hn_runs_release(all, *out);
        hn_runs_delete(all, question->id);
    } else if (*out) {
        return HN_OK;
    }
    pthread_mutex_lock(&all->lock);
    *out = find_here(all, question->id);
    hn_status status = HN_OK;
    if (!*out) {
        status = begin_new(all, question, client, out);
        *begun = status == HN_OK;
    }
    pthread_mutex_unlock(&all->lock);
    return status;
}

void hn_runs_delete(hn_runs *all, const char *id) {
    pthread_mutex_lock(&all->lock);
    hn_kept_run **place = find_place(all, id), *dead = NULL;
    if (*place) {
        atomic_store(&(*place)->stop, 1);
        dead = drop(take_out(all, place));
    }
    hn_run_folder_delete(all->opts->runs_folder, id); // before anybody asks the question again
    pthread_mutex_unlock(&all->lock);
    hn_kept_run_free(dead);
}

hn_run_phase hn_runs_phase(hn_runs *all, const hn_kept_run *run) {
    pthread_mutex_lock(&all->lock);
    const hn_run_phase phase = run->phase;
    pthread_mutex_unlock(&all->lock);
    return phase;
}

int hn_runs_wait(hn_runs *all, hn_client client, const char *id) {
    return hn_jobs_wait(all->jobs, client, key_of(id));
}

void hn_runs_list(hn_runs *all, void (*see)(void *user, const char *id), void *user) {
    pthread_mutex_lock(&all->lock);
    for (hn_kept_run *run = all->first; run; run = run->next) {
        run->is_known = true;
        see(user, run->id);
    }
    pthread_mutex_unlock(&all->lock);
}
