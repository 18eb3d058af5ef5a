// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/routes/static_files.h"

#include "base/arena.h"
#include "base/bundle.h"
#include "base/file.h"
#include "base/hash.h"
#include "http/ground/sha256.h"
#include "http/request/gzip.h"
#include "http/request/request.h"

#include <dirent.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    MAX_FILES = 4000,
    MAX_PATH_CHARS = 4096,
    MAX_NESTING = 8,
    MAX_HTML = 1 << 20,
    MAX_ZIPPED = 4 << 20
};

typedef struct file {
    const char *address, *path, *media_type;
    const void *bytes; ///< of a file inside the program; NULL: it lies on the disk
    size_t n_bytes;
    uint64_t hash;             ///< of these bytes
    struct file *next;         ///< among those that came later
    hn_strbuf zipped;          ///< made on the first request; empty until then
    struct timespec zipped_of; ///< when the file was changed that it was made of
} file;

struct hn_static_files {
    hn_arena *arena;
    int n;
    file *files; ///< sorted by address
    const char **addresses;
    const char *folder; ///< in which they lie
    hn_strbuf policy;
    pthread_mutex_t lock; ///< of what is zipped, and of the next two
    file *later;          ///< list: files that were added after the start
    int n_later;
};

static const char *find_media_type(const char *name) {
    static const struct {
        const char *ending, *type;
    } rows[] = {{".html", "text/html; charset=utf-8"},
                {".js", "text/javascript; charset=utf-8"},
                {".mjs", "text/javascript; charset=utf-8"},
                {".css", "text/css; charset=utf-8"},
                {".json", "application/json"},
                {".map", "application/json"},
                {".svg", "image/svg+xml"},
                {".png", "image/png"},
                {".ico", "image/x-icon"},
                {".woff2", "font/woff2"},
                {".woff", "font/woff"},
                {".ttf", "font/ttf"},
                {".txt", "text/plain; charset=utf-8"},
                {".md", "text/markdown; charset=utf-8"},
                {".webmanifest", "application/manifest+json"}};

    // by the ending alone
    const char *dot = strrchr(name, '.');
    for (size_t i = 0; dot && i < sizeof rows / sizeof *rows; i++) {
        if (strcasecmp(dot, rows[i].ending) == 0) {
            return rows[i].type;
        }
    }
    return "application/octet-stream";
}

static bool is_left_out(const char *name) {
    return name[0] == '.' || strcmp(name, "node_modules") == 0 ||
           (strncmp(name, "package", 7) == 0 &&
            strcmp(find_media_type(name), "application/json") == 0);
}

static hn_status add_file(hn_static_files *s, const char *path, size_t n_root) {
    if (s->n == MAX_FILES) {
        return HN_ERR_LIMIT;
    }
    s->files[s->n].path = hn_arena_strdup(s->arena, path);
    s->files[s->n].media_type = find_media_type(path);
    if (!s->files[s->n].path) {
        return HN_ERR_MEMORY;
    }
    s->files[s->n].address = s->files[s->n].path + n_root;
    s->n++;
    return HN_OK;
}

static hn_status list_folder(hn_static_files *s, const char *folder, size_t n_root, int nesting) {
    DIR *dir = nesting < MAX_NESTING ? opendir(folder) : NULL;
    if (!dir) {
        return HN_ERR_IO;
    }
    hn_status status = HN_OK;

    // links are not followed, and nothing hidden is served
    for (struct dirent *e = readdir(dir); e && status == HN_OK; e = readdir(dir)) {
        char path[MAX_PATH_CHARS];
        struct stat st;
        int n = snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        if (is_left_out(e->d_name) || n >= (int)sizeof path || lstat(path, &st) != 0) {
            continue;
        }
        if (S_ISDIR(st.st_mode)) {
            status = list_folder(s, path, n_root, nesting + 1);
        } else if (S_ISREG(st.st_mode)) {
            status = add_file(s, path, n_root);
        }
    }
    closedir(dir);
    return status;
}

/// Those inside the program, below "bundle:/web".
typedef struct bundle_look {
    hn_static_files *s;
    size_t n_root;
    hn_status status;
} bundle_look;

static bool see_bundled(void *user, const char *path) {
    bundle_look *look = user;
    hn_static_files *s = look->s;
    char whole[MAX_PATH_CHARS];
    snprintf(whole, sizeof whole, "%s%s", HN_BUNDLE, path);
    if (strncmp(path, "/web/", 5) != 0) {
        return true;
    }
    look->status = add_file(s, whole, look->n_root);
    if (look->status == HN_OK) {
        file *f = &s->files[s->n - 1];
        f->bytes = hn_bundle_find(whole, &f->n_bytes);
        f->hash = hn_hash_mix(hn_hash_bytes(HN_HASH_START, f->bytes, f->n_bytes));
    }
    return look->status == HN_OK;
}

static hn_status list_files(hn_static_files *s, const char *folder) {
    if (!hn_bundle_is_path(folder)) {
        return list_folder(s, folder, strlen(folder), 0);
    }
    bundle_look look = {.s = s, .n_root = strlen(folder), .status = HN_OK};
    hn_bundle_each(see_bundled, &look);
    return look.status;
}

static int compare_files(const void *a, const void *b) {
    return strcmp(((const file *)a)->address, ((const file *)b)->address);
}

static file *find_file(const hn_static_files *s, const char *address) {
    file key = {.address = address};
    return bsearch(&key, s->files, (size_t)s->n, sizeof key, compare_files);
}

/// 1 when every part of the address names a file or folder that is served, links left out.
static bool is_served(const char *folder, const char *address, char path[MAX_PATH_CHARS]) {
    const size_t n_folder = strlen(folder);
    struct stat st = {.st_mode = S_IFDIR};
    if (snprintf(path, MAX_PATH_CHARS, "%s%s", folder, address) >= MAX_PATH_CHARS) {
        return false;
    }
    for (char *part = path + n_folder; *part == '/';) {
        char *end = part + 1 + strcspn(part + 1, "/"), kept = *end;
        *end = 0;
        const bool is_good = part[1] && S_ISDIR(st.st_mode) && !is_left_out(part + 1) &&
                             lstat(path, &st) == 0 && !S_ISLNK(st.st_mode);
        *end = kept;
        part = end;
        if (!is_good) {
            return false;
        }
    }
    return S_ISREG(st.st_mode);
}

/// A file that was added after the start.
static file *find_later(hn_static_files *s, const char *address) {
    char path[MAX_PATH_CHARS];
    if (hn_bundle_is_path(s->folder) || !is_served(s->folder, address, path)) {
        return NULL;
    }

    // a file found before
    pthread_mutex_lock(&s->lock);
    file *f = s->later;
    while (f && strcmp(f->address, address) != 0) {
        f = f->next;
    }

    // its first request: it is kept for the next
    if (!f && s->n_later < MAX_FILES) {
        f = hn_arena_get(s->arena, sizeof *f);
        const char *kept = f ? hn_arena_strdup(s->arena, path) : NULL;
        if (kept) {
            *f = (file){.address = kept + strlen(s->folder),
                        .path = kept,
                        .media_type = find_media_type(path),
                        .next = s->later};
            s->later = f;
            s->n_later++;
        }
        f = kept ? f : NULL;
    }
    pthread_mutex_unlock(&s->lock);
    return f;
}

/// The hash of each inline import map goes into the policy: browsers take an import map in no other
/// way.
static void allow_import_maps(hn_strbuf *policy, const char *html) {
    static const char open[] = "<script type=\"importmap\">";
    for (const char *at = strstr(html, open); at; at = strstr(at, open)) {
        at += sizeof open - 1;
        const char *end = strstr(at, "</script>");
        if (!end) {
            return;
        }
        char hash[HN_SHA256_BASE64];
        hn_sha256_base64(at, (size_t)(end - at), hash);
        hn_strbuf_printf(policy, " 'sha256-%s'", hash);
    }
}

static void read_import_maps(hn_strbuf *policy, const char *path) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    if (hn_file_read(path, MAX_HTML, &text, NULL) == HN_OK) {
        allow_import_maps(policy, hn_strbuf_text(&text));
    }
    hn_strbuf_reset(&text);
}

static void write_policy(hn_static_files *s) {
    hn_strbuf *p = &s->policy;
    hn_strbuf_clear(p);
    hn_strbuf_add(p, "default-src 'self'; script-src 'self'");
    for (int i = 0; i < s->n; i++) {
        if (strncmp(s->files[i].media_type, "text/html", 9) == 0) {
            read_import_maps(p, s->files[i].path);
        }
    }
    hn_strbuf_add(p, "; style-src 'self'; img-src 'self' data: blob:; "
                     "connect-src 'self'; object-src 'none'; base-uri 'none'; "
                     "form-action 'none'; frame-ancestors 'self'");
}

hn_status hn_static_files_create(const char *folder, hn_static_files **out, hn_diag *diag) {
    hn_static_files *s = calloc(1, sizeof *s);
    hn_status status = s ? HN_OK : HN_ERR_MEMORY;
    if (s) {
        pthread_mutex_init(&s->lock, NULL);
        s->arena = hn_arena_create(1 << 16);
        s->folder = folder;
        s->files = calloc(MAX_FILES, sizeof *s->files);
        s->addresses = calloc(MAX_FILES, sizeof *s->addresses);
        status = s->arena && s->files && s->addresses ? list_files(s, folder) : HN_ERR_MEMORY;
    }

    // sorted, so that an address is found by halving
    if (status == HN_OK) {
        qsort(s->files, (size_t)s->n, sizeof *s->files, compare_files);
        for (int i = 0; i < s->n; i++) {
            s->addresses[i] = s->files[i].address;
        }
        write_policy(s);
        status = s->policy.failed ? HN_ERR_MEMORY : HN_OK;
    }
    if (status != HN_OK) {
        hn_static_files_free(s);
        return hn_diag_set(diag, status, NULL, NULL, "the files of the page in %s: %s", folder,
                           hn_status_text(status));
    }
    *out = s;
    return HN_OK;
}

void hn_static_files_free(hn_static_files *s) {
    if (s) {
        for (int i = 0; i < s->n; i++) {
            hn_strbuf_reset(&s->files[i].zipped);
        }
        for (file *f = s->later; f; f = f->next) {
            hn_strbuf_reset(&f->zipped);
        }
        pthread_mutex_destroy(&s->lock);
        hn_arena_free(s->arena);
        hn_strbuf_reset(&s->policy);
        free(s->files);
        free(s->addresses);
        free(s);
    }
}

const char *hn_static_files_policy(const hn_static_files *s) {
    return hn_strbuf_text(&s->policy);
}

const char *hn_static_files_nearest(const hn_static_files *s, const char *address) {
    return hn_nearest_name(address, s->addresses, s->n);
}

/// 1 when If-None-Match names this tag or is '*'.
static bool is_known(const hn_request *r, const char *tag) {
    const char *known = hn_request_header(r, "If-None-Match");
    return known && (strcmp(known, "*") == 0 || strstr(known, tag));
}

/// Zips the file once for each of its versions. With the lock held; 0 when that cannot be had.
static int zip(file *f, const struct stat *st) {
    if (f->zipped.n > 0 && f->zipped_of.tv_sec == st->st_mtim.tv_sec &&
        f->zipped_of.tv_nsec == st->st_mtim.tv_nsec) {
        return 1;
    }
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_strbuf_reset(&f->zipped);
    const int zipped = hn_file_read(f->path, MAX_ZIPPED, &text, NULL) == HN_OK &&
                       text.n == (size_t)st->st_size &&
                       hn_gzip(&f->zipped, hn_strbuf_text(&text), text.n);
    f->zipped_of = st->st_mtim;
    hn_strbuf_reset(&text);
    return zipped;
}

/// The zipped file as a reply; 0 when the client does not take it, or it is not worth it.
static bool reply_zipped(hn_static_files *s, hn_request *r, file *f, const struct stat *st) {
    if (!hn_gzip_is_worth(f->media_type, (size_t)st->st_size) || !hn_gzip_accepted(r)) {
        return false;
    }
    hn_strbuf copy;
    hn_strbuf_init(&copy);
    pthread_mutex_lock(&s->lock);
    const int zipped = zip(f, st);
    if (zipped) {
        hn_strbuf_add_n(&copy, hn_strbuf_text(&f->zipped), f->zipped.n);
    }
    pthread_mutex_unlock(&s->lock);
    if (!zipped || copy.failed) {
        hn_strbuf_reset(&copy);
        return false;
    }
    hn_reply_bytes(r, MHD_HTTP_OK, f->media_type, &copy);
    hn_reply_header_add(r, "Content-Encoding", "gzip");
    return true;
}

static void close_file(int fd) {
    if (fd >= 0) {
        close(fd);
    }
}

/// The file as it lies there; takes the descriptor.
static void reply_plain(hn_request *r, const file *f, int fd, const struct stat *st) {
    struct MHD_Response *response =
        f->bytes ? MHD_create_response_from_buffer(f->n_bytes, (void *)(uintptr_t)f->bytes,
                                                   MHD_RESPMEM_PERSISTENT)
                 : MHD_create_response_from_fd((size_t)st->st_size, fd);
    if (!response) {
        close_file(fd);
        hn_reply_problem(r, HN_PROBLEM_INTERNAL, NULL, "%s", hn_status_text(HN_ERR_MEMORY));
        return;
    }
    hn_reply_response(r, MHD_HTTP_OK, response);
    hn_reply_header_add(r, "Content-Type", "%s", f->media_type);
}

/// Opens the file where it lies on the disk (*fd is -1 otherwise), and says which version of it
/// there is; false when it has gone.
static bool open_file(const file *f, int *fd, struct stat *st) {
    *fd = -1;
    if (f->bytes) {
        *st = (struct stat){.st_size = (off_t)f->n_bytes};
        st->st_mtim.tv_sec = (time_t)(f->hash >> 1); // the tag of a version is made of it
        return true;
    }
    *fd = open(f->path, O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (*fd < 0 || fstat(*fd, st) != 0) {
        close_file(*fd);
        return false;
    }
    return true;
}

/// The file of an address, also one that has come since the start; NULL: there is none.
static file *find_any(hn_static_files *s, const char *address) {
    file *f = find_file(s, strcmp(address, "/") == 0 ? "/index.html" : address);
    return f ? f : find_later(s, address);
}

bool hn_static_files_has(hn_static_files *s, const char *address) {
    return find_any(s, address) != NULL;
}

int hn_static_files_reply(hn_static_files *s, hn_request *r, const char *address) {
    file *f = find_any(s, address);
    struct stat st;
    int fd;
    if (!f || !open_file(f, &fd, &st)) {
        return 0;
    }

    // one tag for both forms: they have one content
    char tag[64];
    snprintf(tag, sizeof tag, "\"%llx-%llx-%lx\"", (long long)st.st_size,
             (long long)st.st_mtim.tv_sec, st.st_mtim.tv_nsec);
    if (is_known(r, tag)) {
        close_file(fd);
        hn_reply_empty(r, MHD_HTTP_NOT_MODIFIED);
    } else if (reply_zipped(s, r, f, &st)) {
        close_file(fd);
    } else {
        reply_plain(r, f, fd, &st);
    }
    hn_reply_header_add(r, "ETag", "%s", tag);
    hn_reply_header_add(r, "Vary", "Accept-Encoding");
    hn_reply_header_add(r, "Cache-Control", "no-cache");
    return 1;
}
