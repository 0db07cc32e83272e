#include "cli/serve.h"

#include <iostream>
#include <string_view>

#include "base/platform/local_server.h"

namespace littoral::cli {

void serve_page(const std::string& page, const Task& task) {
  const LocalServer server;
  std::cout << "http://127.0.0.1:" << server.port() << "/\n" << std::flush;
  while (true) {
    task.checkpoint();
    server.answer_one(50, [&](const std::string& head, const LocalServer::Send& send) {
      const bool get = head.rfind("GET / ", 0) == 0, only_head = head.rfind("HEAD / ", 0) == 0;
      const std::string_view body = get || only_head ? std::string_view(page) : "not found\n";
      send(std::string("HTTP/1.1 ") + (get || only_head ? "200 OK" : "404 Not Found") +
           "\r\nContent-Type: text/" + (get || only_head ? "html" : "plain") +
           "; charset=utf-8\r\nContent-Length: " + std::to_string(body.size()) +
           "\r\nConnection: close\r\n\r\n");
      if (!only_head) send(body);
    });
  }
}

}  // namespace littoral::cli
