#include "server/http/routes.h"

namespace papilio::server {

using proto::Code;
using proto::Problem;

void Routes::add(const std::string& method, const std::string& path, Handler handler, WhileDraining while_draining) {
  std::map<std::string, Route>& methods = routes_[path];
  methods[method] = {std::move(handler), while_draining};
  if (method == "GET") methods.try_emplace("HEAD", methods["GET"]);
  const auto list_methods = [this, path](Request&) {
    Response response;
    response.status = 204;
    response.headers.emplace_back("Allow", allowed(path));
    return response;
  };
  methods.try_emplace("OPTIONS", Route{list_methods, WhileDraining::answer});
}

const Route& Routes::find(const std::string& method, const std::string& path) const {
  const auto route = routes_.find(path);
  if (route == routes_.end()) throw Problem(Code::not_found, "There is nothing at this path.");
  const auto found = route->second.find(method);
  if (found == route->second.end()) throw Problem(Code::method_not_allowed, "This path takes " + allowed(path) + ".");
  return found->second;
}

std::string Routes::allowed(const std::string& path) const {
  std::string list;
  const auto route = routes_.find(path);
  if (route == routes_.end()) return list;
  for (const auto& [method, answered] : route->second) list += (list.empty() ? "" : ", ") + method;
  return list;
}

}  // namespace papilio::server
