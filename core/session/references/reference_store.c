// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/references/reference_store.h"

#include "base/file.h"
#include "session/references/references.h"
#include "session/store/stored_json.h"

#include "base/hash.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { MOST_BYTES = 256 << 20 };
enum { FORMAT = 2 }; // counts up when the meaning of a member changes

const char *hn_ref_source_name(hn_ref_source source) {
    static const char *const names[] = {"shipped", "kept", "computed"};
    return names[source];
}

hn_ref_request hn_ref_request_default(void) {
    return (hn_ref_request){.time = (double)NAN, .opts = hn_ref_opts_default()};
}

// reading ----

/// Returns 1 if all values are finite. A null, read as NaN, makes a reference invalid.
static bool are_finite(const double *x, size_t n) {
    for (size_t i = 0; i < n; i++) {
        if (!isfinite(x[i])) {
            return false;
        }
    }
    return true;
}

static bool fill(hn_ref *ref, const cJSON *o) {
    const size_t rows = (size_t)ref->n + 1, nu = (size_t)ref->n_user, nc = (size_t)ref->nc;
    const cJSON *means = cJSON_GetObjectItemCaseSensitive(o, "means");
    double scales[4];

    // methods that computed it
    for (int i = 0; i < HN_REF_MEANS; i++) {
        const char *text = cJSON_GetStringValue(cJSON_GetArrayItem(means, i));
        if (!text) {
            return false;
        }
        snprintf(ref->means[i], HN_SPEC_MAX, "%s", text);
    }

    // scales of the errors
    if (!hn_stored_numbers(o, "scales", scales, 4)) {
        return false;
    }
    ref->scales = (hn_scales){scales[0], scales[1], scales[2], scales[3]};

    // columns; multipliers and errors may be NaN
    return hn_stored_text(o, "refused", ref->refused, sizeof ref->refused) &&
           hn_stored_numbers(o, "error", ref->error, HN_ERROR_COUNT) &&
           hn_stored_numbers(o, "q", ref->q, rows * nu) &&
           hn_stored_numbers(o, "v", ref->v, rows * nu) &&
           hn_stored_numbers(o, "lambda", ref->lambda, rows * nc) &&
           hn_stored_numbers(o, "energy", ref->energy, rows) &&
           hn_stored_numbers(o, "between", ref->between, rows * HN_ERROR_COUNT) &&
           are_finite(scales, 4) && are_finite(ref->q, rows * nu) &&
           are_finite(ref->v, rows * nu) && are_finite(ref->energy, rows);
}

hn_ref *hn_reference_take(const cJSON *o, const hn_model *model, double T, int n) {
    const hn_system_info info = hn_system_get_info(hn_model_system(model));
    const uint64_t hash = hn_model_scene(model)->hash;
    char mine[17], its[17];
    double format, time, intervals;
    hn_hash_hex(hash, mine);
    const int fits = o && hn_stored_number(o, "reference", &format) && format == FORMAT &&
                     hn_stored_text(o, "scene_hash", its, sizeof its) && strcmp(mine, its) == 0 &&
                     hn_stored_number(o, "T", &time) && time > 0 && (isnan(T) || time == T) &&
                     hn_stored_number(o, "n", &intervals) && intervals == n;
    hn_ref *ref = fits ? hn_ref_blank(hash, time, n, info.n_user, info.nc) : NULL;
    if (ref && !fill(ref, o)) {
        hn_ref_free(ref);
        ref = NULL;
    }
    return ref;
}

/// The text of a kept reference ends with the hash of what stands before: its own program wrote it,
/// and all of it is there.
static const char MARK[] = ",\"checksum\":\"";

static void seal(hn_strbuf *b, const char *object, size_t n) {
    char hex[17];
    hn_hash_hex(hn_hash_mix(hn_hash_bytes(HN_HASH_START, object, n)), hex);
    hn_strbuf_add_n(b, object, n);
    hn_strbuf_printf(b, "%s%s\"}\n", MARK, hex);
}

static bool is_whole(const hn_strbuf *text) {
    const size_t n_end = strlen(MARK) + 16 + 3; // the hash, quote, brace, end of the line
    if (text->n <= n_end) {
        return false;
    }
    hn_strbuf again;
    hn_strbuf_init(&again);
    seal(&again, hn_strbuf_text(text), text->n - n_end);
    const bool same = !again.failed && again.n == text->n &&
                      memcmp(hn_strbuf_text(&again), hn_strbuf_text(text), text->n) == 0;
    hn_strbuf_reset(&again);
    return same;
}

/// The reference in a file that was kept, as hn_reference_take().
static hn_ref *read_kept(const char *path, const hn_model *model, double T, int n) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    const bool good = hn_file_read_own(path, MOST_BYTES, &text, NULL) == HN_OK && is_whole(&text);
    cJSON *o = good ? cJSON_Parse(hn_strbuf_text(&text)) : NULL;
    hn_ref *ref = hn_reference_take(o, model, T, n);
    cJSON_Delete(o);
    hn_strbuf_reset(&text);
    return ref;
}

/// The reference in a file that is shipped, as hn_reference_take().
static hn_ref *read_ref(const char *path, const hn_model *model, double T, int n) {
    cJSON *o = hn_stored_open(path);
    hn_ref *ref = hn_reference_take(o, model, T, n);
    cJSON_Delete(o);
    return ref;
}

// writing ----

void hn_reference_put(hn_strbuf *b, const hn_model *model, const hn_ref *ref) {
    const size_t rows = (size_t)ref->n + 1, nu = (size_t)ref->n_user, nc = (size_t)ref->nc;
    const double scales[4] = {ref->scales.length, ref->scales.rate, ref->scales.reaction,
                              ref->scales.energy};
    char hex[17];
    hn_hash_hex(ref->scene, hex);

    // identity: format, scene, end time, number of intervals
    hn_json_object(b);
    hn_json_put_int(b, "reference", FORMAT);
    hn_json_put_string(b, "scene", hn_model_scene(model)->id);
    hn_json_put_string(b, "scene_hash", hex);
    hn_json_put_number(b, "T", ref->T);
    hn_json_put_int(b, "n", ref->n);

    // methods, scales and agreement
    hn_json_key(b, "means");
    hn_json_array(b);
    for (int i = 0; i < HN_REF_MEANS; i++) {
        hn_json_string(b, ref->means[i]);
    }
    hn_json_end_array(b);
    hn_json_put_string(b, "refused", ref->refused);
    hn_json_put_numbers(b, "scales", scales, 4);
    hn_json_put_numbers(b, "error", ref->error, HN_ERROR_COUNT);

    // columns over the stored times
    hn_json_put_numbers(b, "q", ref->q, rows * nu);
    hn_json_put_numbers(b, "v", ref->v, rows * nu);
    hn_json_put_numbers(b, "lambda", ref->lambda, rows * nc);
    hn_json_put_numbers(b, "energy", ref->energy, rows);
    hn_json_put_numbers(b, "between", ref->between, rows * HN_ERROR_COUNT);
    hn_json_end_object(b);
}

/// Writes a reference into the cache.
static hn_status keep(const char *path, const hn_model *model, const hn_ref *ref, hn_diag *diag) {
    hn_strbuf b, sealed;
    hn_strbuf_init(&b);
    hn_strbuf_init(&sealed);
    hn_reference_put(&b, model, ref);
    if (!b.failed) {
        seal(&sealed, hn_strbuf_text(&b), b.n - 1); // without its closing brace
    }
    const hn_status status = b.failed || sealed.failed
                                 ? HN_ERR_MEMORY
                                 : hn_file_keep(path, hn_strbuf_text(&sealed), sealed.n, diag);
    hn_strbuf_reset(&b);
    hn_strbuf_reset(&sealed);
    return status;
}

// finding ----

static bool kept_path(const char *folder, uint64_t scene, double T, int n, char out[512]) {
    uint64_t hash = hn_hash_bytes(HN_HASH_START, &scene, sizeof scene);
    char hex[17];
    hash = hn_hash_double(hash, T);
    hn_hash_hex(hn_hash_mix(hn_hash_double(hash, n + 1000.0 * FORMAT)), hex);
    return snprintf(out, 512, "%s/reference-%s.json", folder, hex) < 512;
}

static hn_ref *find_stored(const hn_model *model, const hn_ref_request *r, double T, int n,
                           hn_ref_source *source) {
    const char *shipped = hn_model_reference_path(model);
    char path[512];
    hn_ref *ref = shipped ? read_ref(shipped, model, r->time, n) : NULL;
    *source = HN_REF_SHIPPED;
    if (!ref && r->folder && kept_path(r->folder, hn_model_scene(model)->hash, T, n, path)) {
        ref = read_kept(path, model, T, n);
        *source = HN_REF_KEPT;
    }
    return ref;
}

static hn_status compute(const hn_model *model, const hn_ref_request *r, double T, hn_ref **out,
                         hn_diags *diags) {
    char path[512];
    hn_diag diag = {0};
    const hn_status status = hn_ref_create(hn_model_system(model), hn_model_q(model),
                                           hn_model_v(model), T, &r->opts, out, &diag);
    if (status != HN_OK) {
        return hn_diags_add(diags, status, diag.pointer, diag.hint, "%s", diag.message);
    }
    if (r->folder && kept_path(r->folder, (*out)->scene, T, (*out)->n, path) &&
        keep(path, model, *out, &diag) != HN_OK) {
        return HN_OK; // without it the next study computes it again
    }
    return HN_OK;
}

hn_status hn_reference_get(const hn_model *model, const hn_ref_request *request, hn_ref **out,
                           hn_ref_source *source, hn_diags *diags) {
    const double T = isnan(request->time) ? hn_model_scene(model)->duration : request->time;
    const int n = request->opts.n > 0 ? request->opts.n : HN_REF_TIMES;
    hn_ref_source from = HN_REF_COMPUTED;
    *out = request->again ? NULL : find_stored(model, request, T, n, &from);
    hn_status status = HN_OK;

    // a caller who cannot wait gets an error, not a computation
    if (!*out && request->only_stored) {
        return hn_diags_add(diags, HN_ERR_UNSUPPORTED, NULL,
                            "one is shipped for every scene with its own parameters and time",
                            "no reference solution is stored for this scene with these parameters "
                            "to t = %g s; it has to be computed",
                            T);
    }

    // compute, and report where the reference came from
    if (!*out) {
        from = HN_REF_COMPUTED;
        status = compute(model, request, T, out, diags);
    }
    if (source) {
        *source = from;
    }
    return status;
}

double hn_reference_horizon(const hn_ref *ref, double digits) {
    int k = 0;
    while (k < ref->n &&
           ref->between[(size_t)(k + 1) * HN_ERROR_COUNT + HN_ERROR_Q] <= pow(10, -digits)) {
        k++;
    }
    const double t = ref->T * k / ref->n;
    if (k == ref->n || k == 0) {
        return k == 0 ? 0 : ref->T;
    }
    // two decimal digits, rounded like a literal: 28 / 10, not 28 * 0.1
    const double power = floor(log10(t)) - 1, unit = pow(10, fabs(power));
    return power < 0 ? floor(t * unit + 1e-9) / unit : floor(t / unit + 1e-9) * unit;
}
