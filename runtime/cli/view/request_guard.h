// Decides which requests the viewer's server answers: those of its own page, by its own address.
//
// The server listens on the loopback interface only, where any program of the machine and any page in its browser can
// reach it. The path therefore begins with a secret token, `Host` must be the server's (DNS rebinding: Jackson et
// al., "Protecting Browsers from DNS Rebinding Attacks", 2007), and `Origin` and `Sec-Fetch-Site` must not name
// another site. The page itself may be opened from elsewhere, as from the file that open_browser() writes. Tested by:
// tests/runtime/cli/view/cli_view_attacks_test.cpp
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fathom::cli {

// The parts of a request that decide; empty for a missing header.
struct RequestFacts {
  std::string method, path, host, origin, fetch_site, fetch_mode, content_type;
};

struct Refusal {
  int status;  // of HTTP
  std::string_view reason;
};

// Returns a token of 128 random bits.
std::string random_token();

// True for 16 to 64 letters, digits, `-` and `_`.
bool is_token(std::string_view text);

class RequestGuard {
 public:
  RequestGuard(int port, std::string_view token);

  // Path of the page; the paths of all other answers begin with it.
  const std::string& root() const { return root_; }
  std::string address() const { return "http://" + hosts_[0] + root_; }

  // Returns why the request is refused, or nullopt.
  std::optional<Refusal> refuse(const RequestFacts& request) const;

 private:
  bool is_own_host(std::string_view host) const { return host == hosts_[0] || host == hosts_[1]; }

  std::string hosts_[2];
  std::string root_;
};

}  // namespace fathom::cli
