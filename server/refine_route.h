#pragma once

#include "proto/limits.h"
#include "server/admission.h"
#include "server/http/http.h"

namespace papilio::server {

/// POST /v1/refine: the mesh as the body with parameters in the query, or a form with parts `mesh` and
/// `params`. Answers the refined mesh, or with `Accept: multipart/mixed` each level as it is made and a JSON
/// summary. Throws `Problem`.
///
/// Once a stream has begun its status is sent; what goes wrong then comes as its last part,
/// `application/problem+json`.
[[nodiscard]] Response refine_route(Request& request, const proto::Limits& limits, Admission& admission);

}  // namespace papilio::server
