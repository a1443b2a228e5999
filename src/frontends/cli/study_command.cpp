// SPDX-License-Identifier: Apache-2.0
// takt study: what if? A scenario, what of it varies, what comes of it.
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <thread>

#include "cli/commands.hpp"
#include "cli/companion.hpp"
#include "cli/input_kind.hpp"
#include "cli/interrupt.hpp"
#include "cli/places.hpp"
#include "cli/study_progress.hpp"
#include "cli/terminal.hpp"
#include "cli/threads.hpp"
#include "output/result_folder.hpp"
#include "study/content.hpp"
#include "study/find.hpp"
#include "study/report.hpp"
#include "study/runner.hpp"
#include "study/shrink.hpp"

namespace takt::cli {
namespace {

struct StudyOptions {
  std::string file;
  unsigned jobs = 0;  ///< not said: as many as the machine has cores, each for the threads of one point
  std::uint32_t threads = 1;
  unsigned processes() const { return jobs > 0 ? jobs : std::max(1u, std::thread::hardware_concurrency() / threads); }
  std::string out = "study.sqlite";
  bool resume = false;
  std::string shard = "1/1";
  bool dry_run = false;
  std::string find;
  std::vector<std::string> at;
  bool quiet = false;
};

/// "2/10"; nothing if it is not that.
std::optional<study::Shard> shard_of(const std::string& text) {
  char rest = '\0';
  unsigned long long index = 0;
  unsigned long long count = 0;
  if (std::sscanf(text.c_str(), "%llu/%llu%c", &index, &count, &rest) != 2 || index < 1 || index > count)
    return std::nullopt;
  return study::Shard{index, count};
}

ExitStatus bad(const std::string& message) {
  std::fprintf(stderr, "takt: %s\n", message.c_str());
  return ExitStatus::bad_input;
}

std::unique_ptr<study::Plan> load_plan(const std::string& file) {
  json::Diagnostics diagnostics;
  auto plan = study::load_plan(file, diagnostics);
  if (!plan)
    if (json::Diagnostics other; belongs_elsewhere(file, InputKind::study, other)) diagnostics = other;
  tell(diagnostics);
  return plan;
}

void print_plan(const study::Plan& plan, const study::RunOptions& options) {
  std::printf("%s: %zu variants, %u replications, %llu points, configuration %016llx\n", plan.study.name.c_str(),
              plan.variants.size(), plan.study.replications.count, static_cast<unsigned long long>(plan.points()),
              static_cast<unsigned long long>(plan.digest));
  std::uint64_t in_shard = 0;
  for (std::uint64_t point = 0; point < plan.points(); ++point) in_shard += options.shard.has(point) ? 1 : 0;
  if (options.shard.count > 1)
    std::printf("shard %llu of %llu: %llu points\n", static_cast<unsigned long long>(options.shard.index),
                static_cast<unsigned long long>(options.shard.count), static_cast<unsigned long long>(in_shard));
  constexpr std::size_t most = 1000;
  for (std::size_t v = 0; v < std::min(most, plan.variants.size()); ++v)
    std::printf("%6zu  %s\n", v, study::name_of(plan, plan.variants[v]).c_str());
  if (plan.variants.size() > most) std::printf("        and %zu more\n", plan.variants.size() - most);
}

/// The store of the study, a new one or with --resume the one that is there; null after a problem, which is printed.
std::unique_ptr<study::Store> store_for(const study::Plan& plan, const StudyOptions& options, ExitStatus& status) {
  std::string problem;
  std::unique_ptr<study::Store> store;
  if (!options.resume) {
    store = study::Store::create(options.out, plan, problem);
    status = problem.find("--resume, or") != std::string::npos ? ExitStatus::bad_input : ExitStatus::internal_error;
  } else {
    store = study::Store::open(options.out, problem);
    status = ExitStatus::bad_input;
    if (store) problem = study::why_not_resumed(store->header(), plan, options.out);
  }
  if (problem.empty()) return store;
  std::fprintf(stderr, "takt: %s\n", problem.c_str());
  return nullptr;
}

ExitStatus run_points(const study::Plan& plan, const StudyOptions& options, study::RunOptions& how,
                      StudyProgress& progress) {
  ExitStatus status = ExitStatus::pass;
  std::vector<bool> finished(plan.points(), false);
  std::unique_ptr<study::Store> store;
  // A new store is made only after the validation, so that a mistake leaves nothing behind.
  if (options.resume && !(store = store_for(plan, options, status))) return status;
  if (store)
    if (const std::string problem = store->finished(finished); !problem.empty())
      return bad(options.out + ": " + problem);
  const std::string mistakes = study::validate(plan, how, finished);
  progress.clear();
  if (!mistakes.empty()) {
    std::fputs(mistakes.c_str(), stderr);
    return ExitStatus::bad_input;
  }
  if (how.interrupted()) return ExitStatus::interrupted;
  if (!store && !(store = store_for(plan, options, status))) return status;
  const study::RunSummary summary = study::run_study(plan, *store, how, finished);
  progress.clear();
  if (!summary.problem.empty()) {
    std::fprintf(stderr, "takt: %s: %s\n", options.out.c_str(), summary.problem.c_str());
    return ExitStatus::internal_error;
  }
  std::uint64_t digest = 0;
  std::uint64_t count = 0;
  if (const std::string problem = store->results_digest(digest, count); !problem.empty())
    return bad(options.out + ": " + problem);
  store->tidy();
  std::printf("%s: %llu of %llu points in %s, %llu run now, %llu of these without a result, results %016llx\n",
              plan.study.name.c_str(), static_cast<unsigned long long>(count),
              static_cast<unsigned long long>(plan.points()), options.out.c_str(),
              static_cast<unsigned long long>(summary.ran), static_cast<unsigned long long>(summary.troubled),
              static_cast<unsigned long long>(digest));
  return summary.interrupted ? ExitStatus::interrupted : ExitStatus::pass;
}

ExitStatus answer(study::Plan& plan, const StudyOptions& options, const study::RunOptions& how,
                  StudyProgress& progress) {
  std::string problem;
  const auto question = study::read_question(plan, options.find, options.at, problem);
  if (!question) return bad("--find: " + problem);
  json::Diagnostics diagnostics;
  study::check_names_of_measures(plan, plan.study.measures.size(), diagnostics);
  tell(diagnostics);
  if (diagnostics.has_errors()) return ExitStatus::bad_input;
  const study::Finding finding = study::find(plan, *question, how);
  progress.clear();
  if (!finding.problem.empty()) {
    std::fprintf(stderr, "takt: %s\n", finding.problem.c_str());
    return ExitStatus::internal_error;
  }
  print(study::text_of(plan, *question, finding));
  return finding.interrupted ? ExitStatus::interrupted
         : finding.level()   ? ExitStatus::pass
                             : ExitStatus::requirement_failed;
}

ExitStatus run(const StudyOptions& options) {
  if (options.file.empty()) return bad("takt study: a study file is missing (takt study --help)");
  const auto shard = shard_of(options.shard);
  if (!shard) return bad("--shard " + options.shard + ": expected I/N with I from 1 to N, such as 2/10");
  if (options.out.empty()) return bad("--out: expected the name of a file");
  if (options.find.empty() && !options.dry_run && !can_write({{"--out", options.out, Place::Kind::file}}))
    return ExitStatus::bad_input;
  const auto plan = load_plan(options.file);
  if (!plan) return ExitStatus::bad_input;
  const InterruptGuard interrupt;
  StudyProgress progress(!options.quiet);
  study::RunOptions how;
  how.jobs = options.processes();
  how.threads = options.threads;
  how.shard = *shard;
  how.interrupted = [&] { return interrupt.requested(); };
  how.progress = [&](const char* what, std::uint64_t done, std::uint64_t of) { progress.update(what, done, of); };
  if (!options.find.empty()) return answer(*plan, options, how, progress);
  if (!options.dry_run) return run_points(*plan, options, how, progress);
  const std::string mistakes = study::validate(*plan, how, std::vector<bool>(plan->points(), false));
  progress.clear();
  std::fputs(mistakes.c_str(), stderr);
  if (!mistakes.empty()) return ExitStatus::bad_input;
  if (!options.quiet) print_plan(*plan, how);
  return interrupt.requested() ? ExitStatus::interrupted : ExitStatus::pass;
}

/// How many points a merged store has, and how to come by the others.
ExitStatus say_merged(const std::string& path) {
  std::string problem;
  const auto store = study::Store::open(path, problem);
  std::uint64_t digest = 0;
  std::uint64_t count = 0;
  if (store) problem = store->results_digest(digest, count);
  if (!problem.empty()) return bad(path + ": " + problem);
  const std::uint64_t all = store->header().points();
  std::printf("%s: %llu of %llu points in %s, results %016llx\n", store->header().name.c_str(),
              static_cast<unsigned long long>(count), static_cast<unsigned long long>(all), path.c_str(),
              static_cast<unsigned long long>(digest));
  if (count < all) std::printf("takt study FILE --resume --out %s runs what is missing\n", path.c_str());
  return ExitStatus::pass;
}

void add_merge(Command study, ExitStatus& status) {
  const Command command = study.add_subcommand("merge", "Join the stores of a study's shards into a new one");
  const auto out = std::make_shared<std::string>();
  const auto parts = std::make_shared<std::vector<std::string>>();
  command.add_option("OUT", *out, "The new store").required();
  command.add_option("PARTS", *parts, "The stores that are joined").required();
  command.footer("Example:\n  takt study merge all.sqlite part-*.sqlite");
  command.callback([out, parts, &status] {
    if (!can_write({{"OUT", *out, Place::Kind::file}})) {
      status = ExitStatus::bad_input;
      return;
    }
    const std::string problem = study::merge_stores(*out, *parts);
    status = problem.empty() ? say_merged(*out) : bad(problem);
  });
}

ExitStatus report(const std::string& store, const std::string& out) {
  if (!can_write({{"--out", out, Place::Kind::file}})) return ExitStatus::bad_input;
  std::string problem;
  const auto content = study::read_store(store, problem);
  if (!content) return bad(problem);
  if (const std::string difference = results::difference_to(content->header.maker, store); !difference.empty())
    std::fprintf(stderr, "takt: warning: %s: its figures are those of then\n", difference.c_str());
  print(study::text_summary(*content));
  problem = output::write_file(out, study::html_report(*content));
  if (problem.empty()) return ExitStatus::pass;
  std::fprintf(stderr, "takt: cannot write: %s\n", problem.c_str());
  return ExitStatus::internal_error;
}

void add_report(Command study, ExitStatus& status) {
  const Command command = study.add_subcommand("report", "Tables and charts of a store, as one HTML file");
  const auto store = std::make_shared<std::string>();
  const auto out = std::make_shared<std::string>("study.html");
  command.add_option("STORE", *store, "The store (study.sqlite)").required();
  command.add_option("--out", *out, "The HTML file that is written").type_name("FILE");
  command.footer("Example:\n  takt study report slaves.sqlite --out slaves.html");
  command.callback([store, out, &status] { status = report(*store, *out); });
}

struct ShrinkOptions {
  std::string file;
  std::uint64_t point = 0;
  std::string out = "shrunk.json";
};

ExitStatus shrink(const ShrinkOptions& options) {
  if (!can_write({{"--out", options.out, Place::Kind::file}})) return ExitStatus::bad_input;
  const auto plan = load_plan(options.file);
  if (!plan) return ExitStatus::bad_input;
  if (options.point >= plan->points()) return bad("the study has points 0 to " + std::to_string(plan->points() - 1));
  const InterruptGuard interrupt;
  StudyProgress progress(true);
  study::RunOptions how;
  how.interrupted = [&] { return interrupt.requested(); };
  how.progress = [&](const char* what, std::uint64_t done, std::uint64_t of) { progress.update(what, done, of); };
  const study::Shrunk shrunk = study::shrink(*plan, options.point, how);
  progress.clear();
  if (shrunk.interrupted) return ExitStatus::interrupted;
  if (!shrunk.problem.empty()) return bad(shrunk.problem);
  if (const std::string problem = output::write_file(options.out, json::encode(shrunk.scenario)); !problem.empty()) {
    std::fprintf(stderr, "takt: cannot write: %s\n", problem.c_str());
    return ExitStatus::internal_error;
  }
  std::string broken;
  for (const std::string& limit : shrunk.broken) broken += (broken.empty() ? " " : ", ") + limit;
  std::printf("point %llu (%s, seed %llu): %zu of %zu faults suffice to fail%s, found in %u runs; takt run %s\n",
              static_cast<unsigned long long>(options.point),
              study::name_of(*plan, plan->variants[plan->variant_of(options.point)]).c_str(),
              static_cast<unsigned long long>(plan->seed_of(options.point)), shrunk.scenario.faults.size(),
              shrunk.faults_before, broken.c_str(), shrunk.runs, options.out.c_str());
  return ExitStatus::pass;
}

void add_shrink(Command study, ExitStatus& status) {
  const Command command = study.add_subcommand(
      "shrink", "The least faults with which a point still fails, as a scenario that fails by itself");
  const auto options = std::make_shared<ShrinkOptions>();
  command.add_option("FILE", options->file, "The study file").required();
  command.add_option("POINT", options->point, "The number of a point that fails; takt study report names some")
      .required();
  command.add_option("--out", options->out, "The scenario that is written").type_name("FILE");
  command.footer("Example:\n  takt study shrink FILE 17 --out worst.json && takt run worst.json");
  command.callback([options, &status] { status = shrink(*options); });
}

}  // namespace

void add_study_command(Command app, ExitStatus& status) {
  const Command command = app.add_subcommand("study", companion_help("study"));
  const auto options = std::make_shared<StudyOptions>();
  command.add_option("FILE", options->file, "The study file (JSON, comments allowed)");
  command.add_option("--jobs", options->jobs, "Processes; the results are the same for any number")
      .between(1u, 1024u)
      .type_name("N")
      .default_text("one for each processor");
  add_threads_option(command, options->threads);
  command.add_option("--out", options->out, "The store of the results, SQLite").type_name("STORE");
  command.add_flag("--resume", options->resume, "Go on with a store: run only what is missing");
  command.add_option("--shard", options->shard, "Only the I-th of N parts of the points, for several machines")
      .type_name("I/N");
  command.add_flag("--dry-run", options->dry_run, "Expand and check everything, print the variants, run nothing");
  command.add_option("--find", options->find, "Search instead: \"max slaves such that reaction.start.max <= 1ms\"")
      .type_name("QUESTION");
  command.add_option("--at", options->at, "With --find, another factor's level instead of its baseline (repeatable)")
      .type_name("FACTOR=LEVEL")
      .one_value_each();
  command.add_flag("--quiet", options->quiet, "No progress");
  add_report(command, status);
  add_merge(command, status);
  add_shrink(command, status);
  command.footer(
      "Examples:\n"
      "  takt study scenarios/studies/slaves-hops-cycle.json --out slaves.sqlite\n"
      "  takt study scenarios/studies/slaves-hops-cycle.json --find 'max slaves such that halt <= 300us' --at "
      "cycle=200us\n"
      "  takt study FILE --shard 3/10 --out part-3.sqlite\n"
      "Exit status: 0 all points are there, 1 --find found nothing, 2 bad input (nothing was run), 3 internal error or "
      "a full disk, 130 interrupted.");
  command.callback([command, options, &status] {
    if (!command.has_chosen_subcommand()) status = run(*options);
  });
}

}  // namespace takt::cli
