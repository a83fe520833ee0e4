#include "server/http/exchange.h"

#include <algorithm>
#include <stdexcept>

#include "server/http/form.h"
#include "server/http/request_id.h"

namespace papilio::server {

void Exchange::receive() {
  id_ = request_id({});
  parse_head(connection_.take_head(options_.max_header_bytes), head_);
  id_ = request_id(head_.field("X-Request-Id"));
  framing_ = framing_of(head_);
  body_.emplace(connection_, framing_, options_.max_body_bytes, &held_);
}

void Exchange::refuse_unreadable() const { server::refuse_unreadable(head_, framing_, options_.max_body_bytes); }

bool Exchange::may_keep_alive() const {
  return body_ && body_->complete() && head_.minor_version == 1 && !head_.lists("Connection", "close");
}

void Exchange::set_client(const std::string& name) {
  client_ = name.empty() ? remote_address() : name;
  if (!name.empty() || std::ranges::find(options_.trusted_proxies, client_) == options_.trusted_proxies.end()) return;
  // Each proxy appends the address of its client: only the last one comes from the trusted proxy.
  const std::string forwarded = head_.field("X-Forwarded-For");
  const std::string_view last = trimmed(std::string_view(forwarded).substr(forwarded.rfind(',') + 1));
  if (!last.empty()) client_ = last;
}

std::string Exchange::path_parameter(std::string_view name) const {
  for (const auto& [known, value] : path_parameters_)
    if (known == name) return value;
  return {};
}

std::string Exchange::content_type() const {
  const std::string value = head_.field("Content-Type");
  return lower_case(trimmed(std::string_view(value).substr(0, value.find(';'))));
}

Body Exchange::read_body() {
  if (body_taken_) throw std::logic_error("a request's body was read twice");
  body_taken_ = true;
  // Requested only now, so that a refusal by the handler saves the upload.
  const bool client_waits = head_.minor_version == 1 && head_.lists("Expect", "100-continue");
  if (client_waits && !body_->complete() && !connection_.has_buffered())
    connection_.write("HTTP/1.1 100 Continue\r\n\r\n");
  Body body;
  body.bytes = body_->read();
  body.size = body.bytes.size();
  if (content_type() == "multipart/form-data") {
    body.parts = parse_form(head_.field("Content-Type"), body.bytes);
    body.bytes = {};
  }
  return body;
}

}  // namespace papilio::server
