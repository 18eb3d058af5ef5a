// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/cache_folder.h"

#include "cli/shell/notes.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

bool hn_cache_folder_find(char out[400]) {
    const char *own = getenv("HOLONOM_CACHE"), *xdg = getenv("XDG_CACHE_HOME"),
               *home = getenv("HOME");
    char base[360] = "";
    if (own && own[0]) {
        return snprintf(out, 400, "%s", own) < 400 && (mkdir(out, 0700) == 0 || errno == EEXIST);
    }
    if (xdg && xdg[0] == '/') {
        snprintf(base, sizeof base, "%s", xdg);
    } else if (home && home[0]) {
        snprintf(base, sizeof base, "%s/.cache", home);
    }
    if (!base[0] || (mkdir(base, 0700) != 0 && errno != EEXIST)) {
        return false;
    }
    snprintf(out, 400, "%s/holonom", base);
    return mkdir(out, 0700) == 0 || errno == EEXIST;
}

const char *hn_cache_folder(const hn_args *args, char out[400]) {
    const bool found = hn_cache_folder_find(out);
    if (!found && !args->json) {
        hn_cli_note("holonom: unfinished work is not kept: there is no folder for it; "
                    "HOLONOM_CACHE can name one\n");
    }
    return found ? out : NULL;
}
