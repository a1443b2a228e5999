// SPDX-License-Identifier: Apache-2.0
#include "studio/server.hpp"

#include <httplib.h>

#include "security/secret.hpp"

namespace takt::studio {
namespace {
constexpr std::size_t connection_threads = 160;
}

class Server::Routes {
 public:
  Routes(Interface& interface, const Assets& assets, std::string token)
      : assets_(assets), token_(std::move(token)), interface_(interface) {
    // A port that somebody listens at is taken; by default httplib would share it.
    server_.set_socket_options([](socket_t socket) {
      const int yes = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    server_.set_payload_max_length(most_text);
    // A connection has a thread as long as it lasts. Those of other programs of this machine that say nothing go soon,
    // and are too few to keep the page waiting.
    server_.new_task_queue = [] { return new httplib::ThreadPool(connection_threads); };
    server_.set_read_timeout(2);
    server_.set_write_timeout(10);
    server_.set_keep_alive_timeout(2);
    server_.set_keep_alive_max_count(1000);
    server_.set_default_headers({{"Content-Security-Policy",
                                  "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src "
                                  "'self' data:; connect-src 'self'; frame-ancestors 'none'; "
                                  "base-uri 'none'; form-action 'none'"},
                                 {"X-Content-Type-Options", "nosniff"},
                                 {"Referrer-Policy", "no-referrer"},
                                 {"Cross-Origin-Resource-Policy", "same-origin"},
                                 {"Cache-Control", "no-store"}});
    server_.set_pre_routing_handler(
        [this](const httplib::Request& request, httplib::Response& response) { return admit(request, response); });
    add_page();
    add_interface();
  }

  /// Names that only this page has are asked for: a name that leads here by DNS (rebinding), and pages of others, get
  /// nothing.
  httplib::Server::HandlerResponse admit(const httplib::Request& request, httplib::Response& response) {
    const std::string host = request.get_header_value("Host");
    const bool is_ours = host == own_host("127.0.0.1") || host == own_host("localhost");
    const std::string origin = request.get_header_value("Origin");
    const bool is_foreign = !origin.empty() && origin != "http://" + host;
    if (!is_ours || is_foreign)
      return refuse(response, 403, "this page is for the address that takt studio has printed");
    if (request.path.rfind("/api/", 0) == 0 && !is_token(request.get_header_value("X-Takt-Token")))
      return refuse(response, 403, "the token of the address is missing");
    if (request.path == "/" && !is_token(request.get_param_value("token")))
      return refuse(response, 403, "the token of the address is missing");
    return httplib::Server::HandlerResponse::Unhandled;
  }

  httplib::Server server_;
  std::uint16_t port_ = 0;
  const std::string& token() const { return token_; }

 private:
  std::string own_host(const char* name) const { return std::string(name) + ":" + std::to_string(port_); }

  static httplib::Server::HandlerResponse refuse(httplib::Response& response, int status, const std::string& why) {
    response.status = status;
    response.set_content(why + "\n", "text/plain; charset=utf-8");
    return httplib::Server::HandlerResponse::Handled;
  }

  bool is_token(const std::string& given) const {
    return given.size() == token_.size() &&
           security::equal_in_constant_time(std::as_bytes(std::span(given)), std::as_bytes(std::span(token_)));
  }

  void add_page() {
    const auto serve = [this](const char* path, std::string_view content, const char* type) {
      server_.Get(path, [content, type](const httplib::Request&, httplib::Response& response) {
        response.set_content(content.data(), content.size(), type);
      });
    };
    serve("/", assets_.html, "text/html; charset=utf-8");
    serve("/page.js", assets_.script, "text/javascript; charset=utf-8");
    serve("/page.css", assets_.style, "text/css; charset=utf-8");
  }

  void add_interface() {
    using Add = httplib::Server& (httplib::Server::*)(const std::string&, httplib::Server::Handler);
    for (const Interface::Route& route : Interface::routes()) {
      const auto handle = [this, route](const httplib::Request& request, httplib::Response& response) {
        Answer answer =
            interface_.answer(route, {[&](const char* name) { return request.get_param_value(name); }, request.body});
        response.status = answer.status;
        response.set_content(std::move(answer.body), answer.type);
      };
      const std::string_view method = route.method;
      const Add add = method == "PUT"      ? static_cast<Add>(&httplib::Server::Put)
                      : method == "DELETE" ? static_cast<Add>(&httplib::Server::Delete)
                                           : static_cast<Add>(&httplib::Server::Get);
      (server_.*add)(route.path, handle);
    }
  }

  const Assets assets_;
  const std::string token_;
  Interface& interface_;
};

Server::Server(Interface& interface, const Assets& assets, std::string token)
    : routes_(std::make_unique<Routes>(interface, assets, std::move(token))) {}
Server::~Server() = default;

bool Server::bind(std::uint16_t port) {
  if (port == 0) {
    const int found = routes_->server_.bind_to_any_port("127.0.0.1");
    if (found <= 0) return false;
    routes_->port_ = static_cast<std::uint16_t>(found);
    return true;
  }
  routes_->port_ = port;
  return routes_->server_.bind_to_port("127.0.0.1", port);
}

std::uint16_t Server::port() const { return routes_->port_; }
const std::string& Server::token() const { return routes_->token(); }
std::string Server::address() const { return "http://127.0.0.1:" + std::to_string(port()) + "/?token=" + token(); }
void Server::listen() { routes_->server_.listen_after_bind(); }
void Server::stop() { routes_->server_.stop(); }

}  // namespace takt::studio
