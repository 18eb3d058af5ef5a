// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/late_library.h"

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

bool hn_late_library_open(hn_late_library *lib) {
    for (const char *const *file = lib->files; *file && !lib->handle; file++) {
        lib->handle = dlopen(*file, RTLD_LAZY | RTLD_LOCAL);
    }
    if (!lib->handle) {
        const char *why = dlerror();
        snprintf(lib->missing, sizeof lib->missing, "%s cannot be loaded (%.120s)", lib->name,
                 why ? why : "");
    }
    return lib->handle != NULL;
}

// A conversion from void * to a function is not ISO C; POSIX promises equal representations.
bool hn_late_library_find(hn_late_library *lib, const char *name, void *out) {
    void *const symbol = dlsym(lib->handle, name);
    memcpy(out, &symbol, sizeof symbol);
    if (!symbol) {
        snprintf(lib->missing, sizeof lib->missing, "%s has nothing named %s", lib->name, name);
    }
    return symbol != NULL;
}

hn_status hn_late_library_check(const hn_late_library *lib, const char *consequence,
                                hn_diag *diag) {
    char hint[HN_DIAG_HINT];
    if (!lib->missing[0]) {
        return HN_OK;
    }
    snprintf(hint, sizeof hint, "install %s", lib->package);
    return hn_diag_set(diag, HN_ERR_UNSUPPORTED, NULL, hint, "%s, so %s", lib->missing,
                       consequence);
}
