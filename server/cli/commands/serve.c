// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/folder.h"
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/print.h"
#include "http/request/token.h"
#include "http/routes/server.h"

#include <errno.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/// An option that is a number: the default stands in the field, `given` is NaN where it is not
/// said.
typedef struct bounded {
    const char *option;
    double given, min, max;
    int *whole; ///< the field, or `seconds` is
    double *seconds;
} bounded;

static hn_status choose(const bounded *o, hn_diag *diag) {
    if (isnan(o->given)) {
        return HN_OK;
    }
    if (!(o->given >= o->min && o->given <= o->max)) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL,
                           "%s is %.15g; %s from %g to %g is allowed", o->option, o->given,
                           o->whole ? "a whole number" : "a number", o->min, o->max);
    }
    if (o->whole) {
        *o->whole = (int)o->given;
    } else {
        *o->seconds = o->given;
    }
    return HN_OK;
}

/// The proxies that are believed.
static hn_status read_proxies(const hn_words *words, hn_proxies *out, hn_diag *diag) {
    if (words->n > HN_MAX_PROXIES) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, "one network may stand for many addresses",
                           "--proxy is given %d times; at most %d are allowed", words->n,
                           HN_MAX_PROXIES);
    }
    for (int i = 0; i < words->n; i++) {
        if (!hn_network_read(words->word[i], &out->network[out->n++])) {
            return hn_diag_set(diag, HN_ERR_INPUT, NULL, "10.0.0.5, 10.0.0.0/8 or fd00::/8",
                               "--proxy takes an address or a network, and '%.60s' is neither",
                               words->word[i]);
        }
    }
    return HN_OK;
}

static hn_status read_opts(const hn_args *args, hn_http_opts *opts, hn_diag *diag) {
    *opts = hn_http_opts_default();
    if (args->host) {
        opts->host = args->host;
    }
    opts->runs_folder = args->runs;
    opts->allow_hosts = args->allow_hosts.word;
    opts->n_allow_hosts = args->allow_hosts.n;
    if (opts->n_allow_hosts > HN_MAX_HOSTS) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL,
                           "--allow-host is given %d times; at most %d are allowed",
                           opts->n_allow_hosts, HN_MAX_HOSTS);
    }

    HN_TRY(read_proxies(&args->proxies, &opts->proxies, diag));

    // numbers within their bounds
    const bounded numbers[] = {
        {"--port", args->port, 0, 65535, &opts->port, NULL},
        {"--history", args->history, 1, 1e6, &opts->max_events, NULL},
        {"--max-comparisons", args->max_comparisons, 1, 1000, &opts->max_comparisons, NULL},
        {"--max-streams", args->max_streams, 1, 4000, &opts->max_streams, NULL},
        {"--max-connections", args->max_connections, 1, 8000, &opts->max_connections, NULL},
        {"--run-cpu", args->run_cpu, 0.01, 3600, NULL, &opts->max_run_cpu},
        {"--idle-pause", args->idle_pause, 0.1, 1e6, NULL, &opts->idle_pause},
        {"--expiry", args->expiry, 0.1, 1e6, NULL, &opts->expiry},
        {"--keep-alive", args->keep_alive, 0.1, 20, NULL, &opts->keep_alive}};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        HN_TRY(choose(&numbers[i], diag));
    }
    return HN_OK;
}

/// Makes the folder of runs where it is not there, for its owner alone.
static hn_status make_runs_folder(const char *path, hn_diag *diag) {
    if (!path || mkdir(path, 0700) == 0) {
        return HN_OK;
    }
    const int error = errno;
    const char *why = error != EEXIST                  ? strerror(error)
                      : !hn_folder_exists(path)        ? "it is not a folder"
                      : access(path, W_OK | X_OK) != 0 ? strerror(errno)
                                                       : NULL;
    return why ? hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL,
                             "--runs: no run can be kept in '%.200s': %s", path, why)
               : HN_OK;
}

static bool is_this_machine(const char *host) {
    static const char *const names[] = {"127.0.0.1", "localhost", "::1"};
    for (int i = 0; i < 3; i++) {
        if (strcmp(host, names[i]) == 0) {
            return true;
        }
    }
    return false;
}

/// A token that can stand in a link and in a cookie, and that nobody finds by trying: some thousand
/// can be tried in a second, and 12 characters have 10^18 values at least.
static hn_status check_token(const char *token, hn_diag *diag) {
    enum { SHORTEST = 12, LONGEST = 128 };
    static const char hint[] = "--token auto makes one, and --token none asks for none";
    const size_t n = strlen(token);
    if (strspn(token, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_.~") != n) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, hint,
                           "--token takes only letters, digits and -_.~, no blanks, because it "
                           "becomes part of a link");
    }
    if (n < SHORTEST || n > LONGEST) {
        return hn_diag_set(
            diag, HN_ERR_INPUT, NULL, hint,
            "--token has %zu characters; %d to %d are allowed, because a shorter one "
            "can be found by trying",
            n, SHORTEST, LONGEST);
    }
    return HN_OK;
}

/// The token that was given, one that is made where others can reach the server, or none.
static hn_status choose_token(const hn_args *args, hn_http_opts *opts, char made[HN_TOKEN],
                              hn_diag *diag) {
    const int wanted =
        args->token ? strcmp(args->token, "none") != 0 : !is_this_machine(opts->host);
    opts->guests = args->guests;
    opts->token = !wanted                                           ? NULL
                  : args->token && strcmp(args->token, "auto") != 0 ? args->token
                                                                    : made;
    if (opts->token == made && !hn_token_make(made)) {
        return hn_diag_set(diag, HN_ERR_INTERNAL, NULL, "take --token TEXT",
                           "no token could be made: the system gives no random numbers");
    }
    return opts->token ? check_token(opts->token, diag) : HN_OK;
}

static void announce(const hn_server *server, const hn_args *args, const hn_http_opts *opts) {
    int port = hn_server_port(server);
    if (opts->port != 0 && port != opts->port) {
        fprintf(stderr, "holonom: port %d is already in use; port %d is used instead\n", opts->port,
                port);
    }

    // a script reads the address, a person clicks on it
    if (args->json) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_json_object(&b);
        hn_json_put_string(&b, "address", hn_server_address(server, 0));
        hn_json_key(&b, "addresses");
        hn_json_array(&b);
        for (int i = 0; hn_server_address(server, i); i++) {
            hn_json_string(&b, hn_server_address(server, i));
        }
        hn_json_end_array(&b);
        hn_json_put_int(&b, "port", port);
        hn_json_put_int(&b, "process", getpid());
        if (opts->token) {
            hn_json_put_string(&b, "token", opts->token);
        }
        hn_json_end_object(&b);
        hn_cli_print(&b);
        return;
    }
    for (int i = 0; hn_server_address(server, i); i++) {
        printf("%s %s/%s%s\n", i == 0 ? "holonom is at" : "           or",
               hn_server_address(server, i), opts->token ? "?token=" : "",
               opts->token ? opts->token : "");
    }
    if (isatty(STDOUT_FILENO)) {
        printf("Space play and pause   arrows step   - = speed   Backspace reset   "
               "Ctrl+C here ends it\n");
    }
    if (args->programs) {
        printf(
            "Programs in %s may run, as the method program:NAME; '+ add' on the page lists them. "
            "'holonom help program' says how to write one\n",
            args->programs);
    }
    fflush(stdout);
}

/// Hands the address to the desktop, in a process of its own.
static void open_browser(const char *address) {
    pid_t pid = fork();
    if (pid == 0) {
        sigset_t none;
        sigemptyset(&none);
        sigprocmask(SIG_SETMASK, &none, NULL);
        execlp("xdg-open", "xdg-open", address, (char *)NULL);
        fprintf(stderr, "holonom: xdg-open is not installed; open %s in a browser\n", address);
        _exit(1);
    }
    if (pid < 0) {
        fprintf(stderr, "holonom: no browser could be started; open %s in a browser\n", address);
    }
}

/// Time that the server may take to end; sanitised programs are some five times slower.
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
static const struct timespec PATIENCE = {.tv_sec = 13};
#else
static const struct timespec PATIENCE = {.tv_sec = 2};
#endif

/// Ends the program if the server has not ended by then.
static void *end_anyway(void *unused) {
    nanosleep(&PATIENCE, NULL);
    fprintf(stderr, "holonom: the server ended although some work did not stop in time\n");
    _exit(HN_EXIT_DONE);
    return unused;
}

static void end_in_time(void) {
    pthread_t thread;
    if (pthread_create(&thread, NULL, end_anyway, NULL) == 0) {
        pthread_detach(thread);
    }
}

/// Makes room for a descriptor per connection; where the system allows fewer, there are fewer
/// connections.
static void fit_descriptors(hn_http_opts *opts) {
    struct rlimit limit;
    const rlim_t wanted = (rlim_t)hn_server_descriptors(opts);
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= wanted) {
        return;
    }
    const bool enough = limit.rlim_max == RLIM_INFINITY || limit.rlim_max >= wanted;
    limit.rlim_cur = enough ? wanted : limit.rlim_max;
    setrlimit(RLIMIT_NOFILE, &limit);
    if (enough) {
        return;
    }

    // as many connections as fit, ten at least
    const int asked = opts->max_connections;
    while (opts->max_connections > 10 && (rlim_t)hn_server_descriptors(opts) > limit.rlim_max) {
        opts->max_connections--;
    }
    fprintf(stderr,
            "holonom: the system allows %llu open files, so the server takes %d connections at "
            "once, not %d; 'ulimit -n %d' allows all\n",
            (unsigned long long)limit.rlim_max, opts->max_connections, asked, (int)wanted);
}

hn_exit hn_command_serve(const hn_library *lib, const hn_args *args) {
    hn_http_opts opts;
    hn_server *server = NULL;
    hn_diag diag = {0};
    sigset_t stop;
    char token[HN_TOKEN];
    if (read_opts(args, &opts, &diag) != HN_OK ||
        make_runs_folder(opts.runs_folder, &diag) != HN_OK ||
        choose_token(args, &opts, token, &diag) != HN_OK) {
        return hn_report_diag(args, &diag);
    }

    // blocked before any thread starts, so that only the wait below takes them
    sigemptyset(&stop);
    sigaddset(&stop, SIGINT);
    sigaddset(&stop, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &stop, NULL);
    signal(SIGPIPE, SIG_IGN);
    if (args->open) {
        signal(SIGCHLD, SIG_IGN);
    }
    fit_descriptors(&opts);
    if (hn_server_start(lib, &opts, &server, &diag) != HN_OK) {
        return hn_report_diag(args, &diag);
    }
    announce(server, args, &opts);
    if (args->open) {
        char link[512];
        snprintf(link, sizeof link, "%s/%s%s", hn_server_address(server, 0),
                 opts.token ? "?token=" : "", opts.token ? opts.token : "");
        open_browser(link);
    }
    int which;
    sigwait(&stop, &which);
    // asked a second time, it ends at once
    pthread_sigmask(SIG_UNBLOCK, &stop, NULL);
    end_in_time();
    hn_server_stop(server);
    return HN_EXIT_DONE;
}
