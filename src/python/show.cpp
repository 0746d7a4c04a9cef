#include "base/error.h"
#include "python/bindings.h"
#include "python/simulator/interpreter.h"
#include "python/simulator/scripted_simulator.h"
#include "viewer/live/watched_session.h"
#include "viewer/page.h"
#include "viewer/server/request_check.h"
#include "viewer/server/server.h"

#include <atomic>
#include <memory>
#include <string>
#include <thread>

namespace py = pybind11;

namespace sprung::python {
namespace {

/// A server in a thread of its own, which shows a simulator after each call that steps it.
class Viewer {
 public:
  Viewer(std::shared_ptr<ScriptedSimulator> simulator, const std::string& title, int port)
      : simulator_(std::move(simulator)),
        session_(std::make_shared<WatchedSession>(title)),
        server_({.port = static_cast<std::uint16_t>(port), .token = random_token(), .page = viewer_page()}, *session_) {
    session_->show(simulator_->read(), true);
    simulator_->on_step([session = session_](const Simulator& stepped) { session->show(stepped); });
    thread_ = std::thread([this] { server_.serve([this] { return is_closed_.load(); }); });
  }
  ~Viewer() { close(); }
  Viewer(const Viewer&) = delete;

  [[nodiscard]] std::string address() const { return server_.address(); }
  void refresh() { session_->show(simulator_->read(), true); }
  void close() {
    is_closed_ = true;
    simulator_->on_step({});
    const WithoutLock without_lock;
    if (thread_.joinable()) thread_.join();
  }

 private:
  std::shared_ptr<ScriptedSimulator> simulator_;
  std::shared_ptr<WatchedSession> session_;
  ViewServer server_;
  std::atomic<bool> is_closed_ = false;
  std::thread thread_;
};

std::unique_ptr<Viewer> show(const std::shared_ptr<ScriptedSimulator>& simulator, bool open, int port) {
  const std::string file = simulator->origin() ? simulator->origin()->source.file : "";
  const std::string name = file.substr(file.rfind('/') + 1);
  const std::string title = name.empty() || name == "<dict>" ? "sprung" : name;
  auto viewer = std::make_unique<Viewer>(simulator, title, port);
  if (open) py::module_::import("webbrowser").attr("open")(viewer->address());
  return viewer;
}

}  // namespace

void bind_show(py::module_& module) {
  py::class_<Viewer>(module, "Viewer", R"(A page that shows a simulator while the program steps it, made by sprung.show().

Use it in a with statement, or close() it.)")
      .def_property_readonly("address", &Viewer::address, "The address of the page, on this machine alone.")
      .def("refresh", &Viewer::refresh, R"(refresh(self)
--

Show the present. step() and frame() do so themselves, at most 60 times a second.)")
      .def("close", &Viewer::close, "close(self)\n--\n\nEnd the server. The page keeps what it shows.")
      .def("__enter__", [](const py::object& self) { return self; })
      .def("__exit__", [](Viewer& self, const py::args& /*error*/) { self.close(); });
  module.def("show", &show, py::arg("simulator"), py::kw_only(), py::arg("open") = true, py::arg("port") = 0,
             R"(show(simulator, *, open=True, port=0)
--

Show a running simulator in the browser, while the program steps it. open: open a browser; otherwise only Viewer.address is there.
port 0: any free one. Returns a Viewer. Without the viewer in the build, raises RuntimeError.)");
}

}  // namespace sprung::python
