#include "runtime/cli/view/request_guard.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>

namespace fathom::cli {

std::string random_token() {
  std::random_device random;
  std::string token;
  for (int word = 0; word < 4; ++word) token += fmt::format("{:08x}", random() & 0xffffffffu);
  return token;
}

bool is_token(std::string_view text) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  };
  return text.size() >= 16 && text.size() <= 64 && std::all_of(text.begin(), text.end(), allowed);
}

RequestGuard::RequestGuard(int port, std::string_view token)
    : hosts_{fmt::format("127.0.0.1:{}", port), fmt::format("localhost:{}", port)},
      root_(fmt::format("/{}/", token)) {}

std::optional<Refusal> RequestGuard::refuse(const RequestFacts& request) const {
  constexpr std::string_view kScheme = "http://";
  if (!is_own_host(request.host)) return Refusal{403, "the host is not this server"};
  if (!request.origin.empty() &&
      (!request.origin.starts_with(kScheme) || !is_own_host(request.origin.substr(kScheme.size())))) {
    return Refusal{403, "the request comes from another site"};
  }
  const bool opens_page = request.method == "GET" && request.path == root_ && request.fetch_mode == "navigate";
  if (!opens_page && !request.fetch_site.empty() && request.fetch_site != "same-origin" &&
      request.fetch_site != "none") {
    return Refusal{403, "the request comes from another site"};
  }
  // A wrong token gets the same answer as a missing page.
  if (!request.path.starts_with(root_)) return Refusal{404, "there is nothing here"};
  if (request.method != "GET" && request.method != "POST") return Refusal{405, "only GET and POST are answered"};
  if (request.method == "POST" && request.content_type != "application/json") {
    return Refusal{415, "the content must be application/json"};
  }
  return std::nullopt;
}

}  // namespace fathom::cli
