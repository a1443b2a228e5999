// SPDX-License-Identifier: Apache-2.0
#include "studio/interface.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>

#include "explain/ask.hpp"
#include "json/document.hpp"
#include "json/node.hpp"
#include "json/record.hpp"
#include "scenario/resolve.hpp"
#include "study/report.hpp"

namespace takt::studio {
namespace {

constexpr std::chrono::milliseconds longest_wait{15'000};
constexpr std::chrono::milliseconds longest_blindness{300};  // of changes of the file
constexpr std::size_t most_timelines = 3;
constexpr std::size_t most_layout = 1'000'000;  // octets

std::string text_json(std::string_view text) { return json::compact(json::Node::of_string(text)); }

/// JSON that is text already, or null.
std::string embedded(const std::string& text) { return text.empty() ? "null" : text; }

Answer told(const std::string& problem) {
  return {problem.empty() ? 200 : 500, "{\"problem\": " + text_json(problem) + "}"};
}
Answer refused(int status, const std::string& why) { return {status, why + "\n", "text/plain; charset=utf-8"}; }
Answer not_there() { return refused(409, "the text is another one by now, or it is not sound"); }

/// As browsers read it, without comments; nothing if it is none.
std::optional<std::string> plain_json(std::string_view text) {
  json::Diagnostics unused;
  const auto document = json::parse(text, "layout", unused);
  return document ? std::optional(json::compact(document->root())) : std::nullopt;
}

}  // namespace

std::uint64_t Request::number(const char* name) const {
  const std::string text = parameter(name);
  if (text.empty()) return 0;
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? number : no_number;
}

std::string too_large(const std::string& path, std::uintmax_t octets) {
  const auto tenths = (octets + 99'999) / 100'000;
  return path + " has " + std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) +
         " MB: takt studio takes texts of at most 8 MB";
}

Interface::Interface(Engine& engine, Document& document, std::string schema, std::string program)
    : engine_(engine), document_(document), schema_(std::move(schema)), program_(std::move(program)) {}
Interface::~Interface() = default;

std::span<const Interface::Route> Interface::routes() {
  static constexpr std::array<Route, 16> all = {{
      {"GET", "/api/schema", &Interface::schema},
      {"GET", "/api/file", &Interface::file},
      {"PUT", "/api/file", &Interface::save},
      {"PUT", "/api/text", &Interface::text},
      {"GET", "/api/findings", &Interface::findings},
      {"GET", "/api/layout", &Interface::layout},
      {"PUT", "/api/layout", &Interface::keep_layout},
      {"GET", "/api/timeline", &Interface::timeline},
      {"GET", "/api/piece", &Interface::piece},
      {"GET", "/api/explain", &Interface::explain},
      {"GET", "/api/studies", &Interface::studies},
      {"PUT", "/api/explore", &Interface::explore},
      {"PUT", "/api/compare", &Interface::compare},
      {"PUT", "/api/study", &Interface::study},
      {"GET", "/api/errand", &Interface::errand},
      {"DELETE", "/api/errand", &Interface::end_errand},
  }};
  return all;
}

void Interface::stop() {
  ends_ = true;
  engine_.end();
  const std::lock_guard lock(errands_mutex_);
  errands_.clear();
}

std::function<bool()> Interface::interrupted(std::uint64_t revision) {
  return [this, revision] { return ends_ || !engine_.is_current(revision); };
}

Answer Interface::schema(const Request&) { return {200, schema_}; }

Answer Interface::file(const Request&) {
  std::string problem;
  auto saved = document_.saved(problem);
  auto draft = document_.draft();
  const std::string digest = saved ? Document::digest_of(*saved) : std::string();
  for (auto* const each : {&saved, &draft}) {
    if (!*each || (*each)->size() <= most_text) continue;
    problem = too_large(each == &saved ? document_.path() : document_.draft_path(), (*each)->size());
    each->reset();
  }
  return {200, "{\"path\": " + text_json(document_.path()) + ", \"saved\": " + (saved ? text_json(*saved) : "null") +
                   ", \"digest\": " + text_json(digest) + ", \"draft\": " + (draft ? text_json(*draft) : "null") +
                   ", \"draft_is_older\": " + (draft && document_.is_newer_than_draft() ? "true" : "false") +
                   ", \"problem\": " + text_json(problem) + "}"};
}

/// The parameter "base" is the digest of the file that the text rests on. A save is of the text that the engine works
/// at from then on.
Answer Interface::save(const Request& request) {
  const Document::Saved saved =
      document_.save(request.body, request.parameter("base"), request.parameter("empty") == "yes");
  const bool is_saved = saved.problem.empty() && !saved.is_conflict && !saved.empties;
  if (const std::uint64_t revision = request.number("revision");
      is_saved && revision > 0 && !engine_.is_current(revision))
    engine_.set_text(revision, std::string(request.body));
  return {saved.problem.empty() ? 200 : 500,
          "{\"problem\": " + text_json(saved.problem) + ", \"conflict\": " + (saved.is_conflict ? "true" : "false") +
              ", \"empties\": " + (saved.empties ? "true" : "false") +
              ", \"digest\": " + text_json(is_saved ? Document::digest_of(request.body) : document_.digest()) + "}"};
}

Answer Interface::text(const Request& request) {
  const bool is_coarse = request.parameter("pace") == "coarse";
  // Under the hand nothing is written: what rests at last is.
  const std::string problem = is_coarse ? std::string() : document_.keep_draft(request.body, request.parameter("base"));
  engine_.set_text(request.number("revision"), std::string(request.body), is_coarse ? Pace::coarse : Pace::exact);
  return {problem.empty() ? 200 : 500,
          "{\"problem\": " + text_json(problem) + ", \"text\": " + text_json(Document::digest_of(request.body)) + "}"};
}

/// Answers as soon as the engine knows something else than `after` says, or the file is another one than `file` says.
Answer Interface::findings(const Request& request) {
  const auto end = std::chrono::steady_clock::now() + longest_wait;
  const std::uint64_t after = request.number("after");
  const std::string known = request.parameter("file");
  Findings f;
  std::string digest;
  do {
    f = engine_.wait_for_other(after, longest_blindness);
    digest = document_.digest();
  } while (f.version == after && digest == known && !ends_ && std::chrono::steady_clock::now() < end);
  return {200, "{\"file\": " + text_json(digest) + ", \"version\": " + std::to_string(f.version) +
                   ", \"revision\": " + std::to_string(f.revision) + ", \"text\": " + text_json(f.text) +
                   ", \"stage\": " + text_json(name_of(f.stage)) + ", \"diagnostics\": " + embedded(f.diagnostics) +
                   ", \"network\": " + embedded(f.network) + ", \"result\": " + embedded(f.result) +
                   ", \"proofs\": " + embedded(f.proofs) + ", \"trouble\": " + text_json(f.trouble) + "}"};
}

Answer Interface::layout(const Request&) { return {200, plain_json(document_.layout()).value_or("{}")}; }

Answer Interface::keep_layout(const Request& request) {
  if (request.body.size() > most_layout || (!request.body.empty() && !plain_json(request.body)))
    return refused(400, "a layout is JSON of at most a megabyte");
  return told(document_.keep_layout(request.body));
}

std::shared_ptr<const scenario::Resolved> Interface::looked_at(const Request& request, Looked& looked) {
  looked = {request.number("revision"), request.parameter("run"), request.number("from")};
  const auto subject = engine_.subject(looked.revision);
  if (!subject) return nullptr;
  if (looked.run.empty()) return subject->resolved;
  const std::uint64_t number = request.number("run");
  if (number >= subject->worst.size() || !subject->worst[number]) return nullptr;
  json::Diagnostics unused;
  return scenario::resolve(subject->worst[number].scenario(), unused);
}

std::shared_ptr<const Timeline> Interface::timeline_of(const Request& request, std::string& problem) {
  Looked looked{request.number("revision"), request.parameter("run"), request.number("from")};
  const std::lock_guard lock(timelines_mutex_);
  if (engine_.is_current(looked.revision))
    for (const auto& [of, timeline] : timelines_)
      if (of == looked) return timeline;
  const auto resolved = looked_at(request, looked);
  if (!resolved) return nullptr;
  if (looked.from >= static_cast<std::uint64_t>(resolved->scenario.duration.ps())) {
    problem = "the run is over by then";
    return nullptr;
  }
  const auto from = sim::TrueTime() + sim::Duration::from_ps(static_cast<std::int64_t>(looked.from));
  std::shared_ptr<const Timeline> made = Timeline::record(*resolved, from, {}, interrupted(looked.revision));
  if (!made) return nullptr;
  std::erase_if(timelines_, [&](const auto& each) { return each.first.revision != looked.revision; });
  if (timelines_.size() == most_timelines) timelines_.erase(timelines_.begin());
  timelines_.emplace_back(looked, made);
  return made;
}

Answer Interface::timeline(const Request& request) {
  std::string problem;
  const auto timeline = timeline_of(request, problem);
  if (!problem.empty()) return refused(400, problem);
  return timeline ? Answer{200, timeline->summary()} : not_there();
}

Answer Interface::piece(const Request& request) {
  std::string problem;
  const auto timeline = timeline_of(request, problem);
  if (!problem.empty()) return refused(400, problem);
  if (!timeline) return not_there();
  return {
      200,
      timeline->piece(static_cast<unsigned>(std::min<std::uint64_t>(request.number("level"), Timeline::greatest_level)),
                      request.number("index"), request.number("first"), request.number("count")),
      Answer::octets};
}

/// Of a frame by stream and sequence; without a stream of what a requirement measured in its worst run.
Answer Interface::explain(const Request& request) {
  Looked looked;
  const auto resolved = looked_at(request, looked);
  if (!resolved) return not_there();
  explain::Explanation made;
  made.scenario = resolved->scenario.name;
  const explain::Interrupted stops = interrupted(looked.revision);
  if (const std::string name = request.parameter("stream"); !name.empty()) {
    const auto stream = explain::stream_named(*resolved, name);
    if (!stream) return refused(400, "no such stream");
    made.question = "stream " + name + ": frame " + std::to_string(request.number("sequence"));
    made.frames = explain::explain_frame(
        *resolved,
        {.stream = stream, .which = explain::FrameQuestion::Which::number, .number = request.number("sequence")},
        stops);
  } else {
    const auto subject = engine_.subject(looked.revision);
    if (!subject || looked.run.empty() || request.number("run") >= subject->requirements.size()) return not_there();
    const results::RequirementResult& asked = subject->requirements[request.number("run")];
    made.question = asked.text + ": the worst run that was found";
    explain::explain_measured(*resolved, asked, made, stops);
  }
  if (stops()) return not_there();
  return {200, json::pretty(json::write_record(describe(json::Type<explain::Explanation>{}), &made))};
}

Answer Interface::studies(const Request&) {
  json::Node list = json::Node::array();
  for (const std::string& name : document_.studies()) list.items.push_back(json::Node::of_string(name));
  return {200, json::compact(list)};
}

Answer Interface::start(const std::string& name, std::vector<std::string> arguments,
                        std::vector<std::shared_ptr<const std::string>> keeps, std::string store) {
  const std::lock_guard lock(errands_mutex_);
  if (ends_) return refused(503, "takt studio is ending");
  Errand& errand = errands_[name];
  errand.command.reset();  // the one before ends first
  errand.store = std::move(store);
  errand.command = Command::start(program_, arguments, std::move(keeps));
  errand.problem = errand.command ? "" : "takt " + name + " cannot be started";
  return told(errand.problem);
}

Answer Interface::explore(const Request& request) {
  const auto file = document_.aside(request.body);
  if (!file) return told("no copy of the text can be written beside " + document_.path());
  std::vector<std::string> arguments = {"explore", *file, "--format", "json", "--quiet", "--budget", "20000000"};
  if (const std::string faults = request.parameter("faults"); !faults.empty())
    arguments.insert(arguments.end(), {"--faults", faults});
  if (const std::string calls = request.parameter("calls"); !calls.empty())
    arguments.insert(arguments.end(), {"--calls", calls});
  return start("explore", std::move(arguments), {file});
}

/// The body is two texts, A and B, the first as long as "length" says, in octets.
Answer Interface::compare(const Request& request) {
  const std::size_t length = std::min<std::size_t>(request.number("length"), request.body.size());
  const auto a = document_.aside(request.body.substr(0, length));
  const auto b = document_.aside(request.body.substr(length));
  if (!a || !b) return told("no copy of the texts can be written beside " + document_.path());
  const Answer of_a = start("verify", {"verify", *a, "--format", "json", "--quiet", "--budget", "20"}, {a});
  if (of_a.status != 200) return of_a;
  return start("compare", {"compare", *a, *b, "--format", "json", "--quiet", "--jobs", "1"}, {a, b});
}

Answer Interface::study(const Request& request) {
  const std::string name = request.parameter("file");
  const std::vector<std::string> known = document_.studies();
  if (std::ranges::find(known, name) == known.end()) return refused(400, "no study file beside the scenario");
  const std::string path = document_.path_of(name);
  const std::string store = path + ".sqlite";
  std::vector<std::string> arguments = {"study", path, "--out", store, "--quiet"};
  std::error_code error;
  if (std::filesystem::exists(store, error)) arguments.push_back("--resume");
  return start("study", std::move(arguments), {}, store);
}

Answer Interface::errand(const Request& request) {
  Command::State state;
  std::string store;
  {
    const std::lock_guard lock(errands_mutex_);
    const auto found = errands_.find(request.parameter("name"));
    if (found == errands_.end() || (!found->second.command && found->second.problem.empty()))
      return refused(404, "nothing of that name was asked for");
    if (!found->second.command) return told(found->second.problem);
    state = found->second.command->state();
    store = found->second.store;
  }
  const bool is_whole =
      !state.is_running && state.output.size() > 1 && (state.output.front() == '{' || state.output.front() == '[');
  std::string page = std::string("{\"running\": ") + (state.is_running ? "true" : "false") +
                     ", \"status\": " + std::to_string(state.status) + ", \"problem\": " + text_json(state.errors) +
                     ", \"output\": " + (is_whole ? state.output : "null");
  if (!store.empty()) {
    std::string problem;
    const auto content = study::read_store(store, problem);  // the first points are still to come if it cannot be read
    page += ", \"points\": " + std::to_string(content ? content->rows() : 0) +
            ", \"of\": " + std::to_string(content ? content->header.points() : 0) +
            ", \"report\": " + text_json(content && content->rows() > 0 ? study::html_report(*content) : "");
  }
  return {200, page + "}"};
}

Answer Interface::end_errand(const Request& request) {
  const std::lock_guard lock(errands_mutex_);
  errands_.erase(request.parameter("name"));
  return told({});
}

}  // namespace takt::studio
