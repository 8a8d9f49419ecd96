// SPDX-License-Identifier: MIT
// What is certain about a context and about a kept mesh after any calls, for random_use_test.cpp: a model of the
// header.
#pragma once

#include "capi/random_use_inputs.h"

#include <future>
#include <map>

namespace random_use {

// Cancels a context now and then, and asks how it is, on a thread of its own.
class Disturber {
 public:
  Disturber(qses_context *context, int times, bool cancels) {
    thread_ = std::thread([this, context, times, cancels] {
      for (int k = 0; k < times && !is_over_; ++k) {
        if (cancels) qses_cancel(context);
        qses_progress p;
        qses_progress_init(&p);
        if (qses_poll(context, &p) != QSES_OK || p.state < QSES_JOB_IDLE || p.state > QSES_JOB_FAILED ||
            !(p.fraction >= 0 && p.fraction <= 1) || p.levels_finished > p.level_count || p.tag > p.tag_requested)
          is_fooled_ = true;
        std::this_thread::sleep_for(std::chrono::microseconds(50));
      }
    });
  }
  ~Disturber() {
    is_over_ = true;
    thread_.join();
    EXPECT_FALSE(is_fooled_) << "poll on another thread";
  }

 private:
  std::atomic<bool> is_over_{false}, is_fooled_{false};
  std::thread thread_;
};

// Holds what is computed in a context from the first that it tells of itself.
class Barrier {
 public:
  static void pass(void *barrier, double fraction) {
    Barrier &self = *static_cast<Barrier *>(barrier);
    if (!(fraction >= 0 && fraction <= 1)) self.is_fooled = true;
    self.is_reached = true;
    while (self.is_shut) std::this_thread::yield();
  }
  std::atomic<bool> is_shut{false}, is_reached{false}, is_fooled{false};
};

// A kept mesh, and what must be in it.
struct KeptModel {
  Kept kept;
  bool is_full = false;
  Snapshot mesh;
  size_t atom_count = 0;
  bool has_owners = false;
  std::future<std::string> reader;  // looks at it on another thread

  // What is wrong with it, or "".
  std::string fault() const {
    qses_mesh view = empty_mesh();
    qses_report report;
    qses_report_init(&report);
    if (qses_kept_mesh_view(kept, &view) != QSES_OK) return "no view";
    const qses_status status = qses_kept_mesh_report(kept, &report);
    if (!is_full) return view.vertex_count == 0 && status == QSES_NO_RESULT ? "" : "it is not empty";
    if (status != QSES_OK) return "no report";
    if (view.tag != mesh.tag || view.level != mesh.level) return "tag or level";
    return Snapshot(view, report).difference(mesh);
  }
  // Before it is changed.
  void wait_for_reader() {
    if (reader.valid()) {
      EXPECT_EQ(reader.get(), "") << "kept mesh, looked at on another thread";
    }
  }
};

class ContextModel {
 public:
  ContextModel(Random &random, uint32_t *last_tag, std::string *what) : last_tag_(last_tag) {
    qses_context_options options;
    qses_context_options_init(&options);
    options.backend = tested_backend();
    options.threads = static_cast<uint32_t>(random.count(1, 3));
    options.background = random.chance(0.3);
    is_short_ = random.chance(0.2);
    const uint64_t budget = uint64_t(1) << random.count(18, 23);
    if (is_short_) options.memory_budget = tested_backend() == QSES_BACKEND_CPU ? budget : budget * 16;
    expect_ok(qses_context_create(&options, &context_));
    *what = std::to_string(options.threads) + " threads, budget " + std::to_string(options.memory_budget);
  }
  ~ContextModel() {
    disturber_.reset();
    qses_context_destroy(context_);
    EXPECT_FALSE(barrier_.is_fooled);
  }
  ContextModel(const ContextModel &) = delete;
  ContextModel &operator=(const ContextModel &) = delete;

  qses_context *get() const { return context_; }
  const std::shared_ptr<const Frame> &frame() const { return frame_; }

  // Takes what the call said for what is so from now on.
  void expect(qses_status status, qses_status expected) { EXPECT_EQ(status, expected) << qses_last_error(); }
  void now_has(std::shared_ptr<const Frame> frame) { frame_ = std::move(frame); }

  void begin(qses_settings s, bool is_good) {
    s.tag = ++*last_tag_;
    const qses_status expected = !is_good ? QSES_INVALID_ARGUMENT : frame_ ? QSES_OK : QSES_NO_ATOMS;
    expect(qses_begin(context_, &s), expected);
    if (expected != QSES_OK) return;
    is_settled_ = false;
    ask_for(s, true);
    check_progress();
  }

  void compute(qses_settings s, bool is_good, bool wants_mesh) {
    s.tag = ++*last_tag_;
    qses_mesh mesh = empty_mesh();
    const qses_status status = qses_compute(context_, &s, wants_mesh ? &mesh : nullptr);
    if (!is_good || !frame_) return expect(status, !is_good ? QSES_INVALID_ARGUMENT : QSES_NO_ATOMS);
    ask_for(s, false);
    is_settled_ = true;
    Request &request = requests_.at(s.tag);
    const qses_progress p = jobs_fixture::poll(context_);
    if (status == QSES_CANCELLED) {
      EXPECT_NE(disturber_, nullptr);
      EXPECT_TRUE(p.state != QSES_JOB_RUNNING && p.state != QSES_JOB_IDLE) << p.state;
      is_cancelled_ = true;
    } else if (status != QSES_OK) {
      expect_failure(status, request);
      EXPECT_EQ(p.state, QSES_JOB_FAILED);
      EXPECT_EQ(p.status, status);
    } else {
      EXPECT_EQ(p.state, QSES_JOB_FINISHED);
      EXPECT_EQ(p.tag, s.tag);
      EXPECT_FALSE(p.mesh_ready);
      if (wants_mesh)
        view_ = mesh;
      else
        expect_ok(qses_context_mesh(context_, &(view_ = empty_mesh())));
      take(request);
    }
    check_progress();
  }

  void collect() {
    const qses_progress before = jobs_fixture::poll(context_);
    qses_mesh mesh = empty_mesh();
    const qses_status status = qses_collect(context_, &mesh);
    if (status == QSES_OK) {
      const auto found = requests_.find(mesh.tag);
      ASSERT_NE(found, requests_.end()) << "a mesh of tag " << mesh.tag;
      EXPECT_TRUE(found->second.is_job) << mesh.tag;
      const std::pair<uint32_t, int> shown(mesh.tag, static_cast<int>(mesh.level));
      EXPECT_TRUE(shown > shown_) << "tag " << mesh.tag << ", level " << mesh.level << " after tag " << shown_.first
                                  << ", level " << shown_.second;
      view_ = mesh;
      take(found->second);
      shown_ = shown;
    } else {
      EXPECT_EQ(status, QSES_NOTHING_NEW) << qses_last_error();
      EXPECT_FALSE(before.mesh_ready);
      check_held();
    }
    if (!is_settled_ || newest_ == 0 || before.state != QSES_JOB_FINISHED || before.tag != newest_) return;
    Request &last = requests_.at(newest_);
    if (!last.is_job) return;
    EXPECT_EQ(shown_.first, newest_) << "the last job is finished, and not collected";
    if (last.settings.frame_budget_ms <= 0) {
      EXPECT_EQ(shown_.second, static_cast<int>(last.finest()));
    }
  }

  void wait(double milliseconds) {
    qses_bool finished = 2;
    expect(qses_wait(context_, milliseconds, &finished), QSES_OK);
    EXPECT_TRUE(finished == 1 || (finished == 0 && milliseconds >= 0));
    if (finished == 1) is_settled_ = true;
    check_progress();
  }

  void cancel() {
    expect(qses_cancel(context_), QSES_OK);
    is_cancelled_ = true;
  }

  void estimate(const qses_settings &s, bool is_good) {
    qses_size_estimate e;
    qses_size_estimate_init(&e);
    const qses_status status = qses_estimate(context_, &s, &e);
    if (!is_good || !frame_) return expect(status, !is_good ? QSES_INVALID_ARGUMENT : QSES_NO_ATOMS);
    is_settled_ = true;
    if (status == QSES_CANCELLED) {
      EXPECT_NE(disturber_, nullptr);
    } else if (status != QSES_OK) {
      expect_failure(status, *std::make_unique<Request>(frame_, s, false));
    }
    check_progress();
    check_held();
  }

  // Calls that wait for a running job.
  void set_stage_times(bool enabled) {
    expect(qses_set_stage_times(context_, enabled), QSES_OK);
    is_settled_ = true;
  }

  enum class Cancel { kNever, kFirst, kAll };

  // A job is held at its begin, another one may follow, and it goes on. Cancelled are none, the first, or all of them.
  void pass_barrier(const qses_settings &first, const qses_settings *second, Cancel cancelled) {
    disturb_no_more();
    expect(qses_set_progress_callback(context_, Barrier::pass, &barrier_), QSES_OK);
    is_settled_ = true;
    barrier_.is_reached = false;
    barrier_.is_shut = true;
    begin(first, true);
    const uint32_t held_tag = newest_;
    while (!barrier_.is_reached && jobs_fixture::poll(context_).state == QSES_JOB_RUNNING) std::this_thread::yield();
    const bool is_held = barrier_.is_reached;
    if (cancelled == Cancel::kFirst) cancel();
    if (second) begin(*second, true);
    if (is_held) {
      const qses_progress p = jobs_fixture::poll(context_);
      EXPECT_EQ(p.state, QSES_JOB_RUNNING);
      EXPECT_EQ(p.tag, held_tag);
      EXPECT_EQ(p.tag_requested, newest_);
      if (second && cancelled == Cancel::kAll) requests_.at(newest_).is_dropped = true;
    }
    if (cancelled == Cancel::kAll) cancel();
    barrier_.is_shut = false;
    expect(qses_set_progress_callback(context_, nullptr, nullptr), QSES_OK);
    is_settled_ = true;
    if (is_held && is_cancelled_) {
      const qses_progress p = jobs_fixture::poll(context_);
      EXPECT_EQ(p.tag, held_tag);
      EXPECT_TRUE(p.state == QSES_JOB_CANCELLED || p.state == QSES_JOB_FAILED) << p.state;
    }
    check_progress();
    collect();
  }

  void keep(KeptModel *kept) {
    kept->wait_for_reader();
    const qses_status status = qses_keep(context_, kept->kept);
    if (!holds_) return expect(status, QSES_NO_RESULT);
    const Request &request = requests_.at(held_.tag);
    if (request.settings.delivery == QSES_DELIVERY_NONE) return expect(status, QSES_INVALID_ARGUMENT);
    expect(status, QSES_OK);
    kept->is_full = true;
    kept->mesh = held_;
    kept->atom_count = request.frame->atoms.size();
    kept->has_owners = !request.settings.without_owners || view_.vertex_count == 0;
    holds_ = false;
    check_held();
  }

  // The view handed out last still shows what it showed, or there is none.
  void check_held() {
    qses_mesh now = empty_mesh();
    qses_report report;
    qses_report_init(&report);
    const qses_status status = qses_context_mesh(context_, &now);
    expect(qses_context_report(context_, &report), holds_ ? QSES_OK : QSES_NO_RESULT);
    if (!holds_) return expect(status, QSES_NO_RESULT);
    expect(status, QSES_OK);
    EXPECT_TRUE(now.positions == view_.positions && now.indices == view_.indices && now.owners == view_.owners &&
                now.tag == view_.tag);
    EXPECT_EQ(Snapshot(view_, report).difference(held_), "");
  }

  void check_progress() {
    const qses_progress p = jobs_fixture::poll(context_);
    EXPECT_EQ(p.tag_requested, newest_);
    EXPECT_EQ(p.status != QSES_OK, p.state == QSES_JOB_FAILED);
    EXPECT_EQ(p.message[0] != '\0', p.state == QSES_JOB_FAILED);
    EXPECT_TRUE(p.fraction >= 0 && p.fraction <= 1) << p.fraction;
    EXPECT_LE(p.levels_finished, p.level_count);
    if (p.tag == seen_.tag && newest_ == seen_.tag_requested) {
      EXPECT_GE(p.fraction, seen_.fraction);
    }
    seen_ = p;
    if (newest_ == 0) return expect_idle(p);
    const auto found = requests_.find(p.tag);
    ASSERT_NE(found, requests_.end()) << p.tag;
    Request &request = found->second;
    EXPECT_FALSE(request.is_dropped && p.state != QSES_JOB_CANCELLED) << p.tag;
    if (request.is_job) {
      EXPECT_EQ(p.level_count, request.settings.frame_budget_ms > 0 ? 1 : request.finest() + 1) << p.tag;
    }
    EXPECT_NE(p.state, QSES_JOB_IDLE);
    if (p.state == QSES_JOB_FINISHED) {
      EXPECT_EQ(p.levels_finished, p.level_count);
      EXPECT_EQ(p.fraction, 1.f);
    }
    if (p.state == QSES_JOB_FAILED) expect_failure(p.status, request);
    if (!is_settled_) return;
    EXPECT_NE(p.state, QSES_JOB_RUNNING);
    if (is_cancelled_ || disturber_) return;
    EXPECT_EQ(p.tag, newest_);
    EXPECT_NE(p.state, QSES_JOB_CANCELLED);
    if (p.state == QSES_JOB_FINISHED && request.settings.frame_budget_ms <= 0) {
      EXPECT_EQ(request.status(), QSES_OK);
    }
  }

  void disturb(int times, bool cancels) {
    disturber_.reset();
    disturber_ = std::make_unique<Disturber>(context_, times, cancels);
    is_cancelled_ = is_cancelled_ || cancels;
  }
  void disturb_no_more() { disturber_.reset(); }

  // Which atoms line the components, if it says which vertices are of which.
  void check_component_atoms() {
    if (!holds_) return;
    const qses_mesh &m = view_;
    std::vector<uint32_t> starts(m.component_count + 1);
    const Request &request = requests_.at(m.tag);
    const qses_status status = qses_component_atoms(&m, starts.data(), nullptr, 0);
    const bool is_there = request.settings.component_ids && !request.settings.without_owners &&
                          request.settings.delivery != QSES_DELIVERY_NONE;
    if (!is_there && m.vertex_count > 0) return expect(status, QSES_INVALID_ARGUMENT);
    expect(status, QSES_OK);
    if (m.vertex_count == 0) return;
    std::vector<uint32_t> atoms(starts.back() + 1);
    expect(qses_component_atoms(&m, starts.data(), atoms.data(), starts.back()), QSES_OK);
    std::vector<std::set<uint32_t>> lining(m.component_count);
    for (uint32_t v = 0; v < m.vertex_count; ++v) lining.at(m.component_ids[v]).insert(m.owners[v]);
    for (uint32_t k = 0; k < m.component_count; ++k)
      EXPECT_TRUE(
          std::equal(lining[k].begin(), lining[k].end(), atoms.begin() + starts[k], atoms.begin() + starts[k + 1]));
  }

 private:
  void ask_for(const qses_settings &s, bool is_job) {
    newest_ = s.tag;
    is_cancelled_ = disturber_ != nullptr;
    requests_.emplace(s.tag, Request(frame_, s, is_job));
  }
  void take(Request &request) {
    held_ = Snapshot(view_, report_of(context_));
    holds_ = true;
    shown_ = {held_.tag, static_cast<int>(held_.level)};
    EXPECT_EQ(held_.tag, request.settings.tag);
    EXPECT_FALSE(request.is_dropped);
    EXPECT_EQ(request.difference(held_), "") << "tag " << held_.tag << ", level " << held_.level;
    if (held_.level < request.finest()) request.check_closed(view_);
    check_held();
  }
  void expect_failure(qses_status status, Request &request) const {
    if (status == QSES_OUT_OF_MEMORY && is_short_) return;
    EXPECT_EQ(status, request.status());
    EXPECT_NE(status, QSES_OK);
  }
  static void expect_idle(const qses_progress &p) {
    EXPECT_EQ(p.state, QSES_JOB_IDLE);
    EXPECT_EQ(p.tag, 0u);
    EXPECT_FALSE(p.mesh_ready);
  }

  qses_context *context_ = nullptr;
  uint32_t *last_tag_;
  bool is_short_ = false;  // of memory
  std::shared_ptr<const Frame> frame_;
  std::map<uint32_t, Request> requests_;   // by their tags
  uint32_t newest_ = 0;                    // tag; 0: none
  bool is_settled_ = true;                 // no job runs or waits
  bool is_cancelled_ = false;              // since the newest request, perhaps
  std::pair<uint32_t, int> shown_{0, -1};  // tag and level of the last mesh
  qses_progress seen_{};
  bool holds_ = false;
  qses_mesh view_ = empty_mesh();
  Snapshot held_;
  Barrier barrier_;
  std::unique_ptr<Disturber> disturber_;
};

}  // namespace random_use
