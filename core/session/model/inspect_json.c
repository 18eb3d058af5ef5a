// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/model/inspect_json.h"

#include "dynamics/analyse/inspect.h"
#include "dynamics/analyse/redundancy.h"
#include "session/model/caption.h"
#include "session/model/model.h"
#include "session/model/model_json.h"
#include "session/model/position_json.h"

static void put_start(hn_strbuf *b, const hn_model *model) {
    const hn_assembly *a = hn_model_assembly(model);
    hn_json_key(b, "start");
    hn_json_object(b);
    hn_model_closed_put(b, model);
    hn_json_put_int(b, "rank", a->rank);
    hn_json_put_int(b, "redundant", a->redundant);
    hn_json_put_int(b, "dof", a->freedoms);
    hn_json_put_number(b, "sigma_min", a->sigma_min);
    hn_json_put_number(b, "sigma_max", a->sigma_max);
    hn_json_put_string(b, "assembly_mode", a->mode_name);
    hn_json_put_string(b, "assembly_modes",
                       a->modes); // one sign per loop, as a scene asks for them
    hn_json_put_number(b, "gap", a->gap);
    hn_json_put_number(b, "velocity_gap", a->velocity_gap);
    hn_json_put_number(b, "energy", a->energy);
    hn_json_end_object(b);
}

hn_status hn_model_inspect_json(hn_strbuf *b, const hn_model *model, hn_diags *diags) {
    char caption[160];
    hn_model_caption(model, caption, sizeof caption);

    // the scene and its start
    hn_json_object(b);
    hn_json_put_string(b, "scene", hn_model_scene(model)->id);
    hn_json_put_string(b, "title", hn_model_scene(model)->title);
    hn_json_put_string(b, "caption", caption);
    put_start(b, model);

    // redundant constraints, actuation, operation counts, position form
    hn_status status = hn_system_redundancy_put(b, hn_model_system(model), 0, hn_model_q(model));
    hn_system_actuation_put(b, hn_model_system(model), hn_model_assembly(model)->freedoms);
    HN_THEN(status, hn_system_inspect_put(b, hn_model_system(model)));
    HN_THEN(status, hn_position_put(b, model));
    hn_json_end_object(b);
    return status == HN_OK
               ? HN_OK
               : hn_diags_add(diags, status, NULL, NULL, "the operations could not be counted: %s",
                              hn_status_text(status));
}
