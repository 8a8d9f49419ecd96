// SPDX-License-Identifier: MIT
// The levels of a frame, made by one plan: one after the other, or, on a GPU, beside each other (coarse_lanes.h). And
// all that they are made with, which is kept from frame to frame.
#pragma once

#include "surface/coarse_lanes.h"
#include "surface/engine.h"
#include "surface/levels_under_way.h"
#include "surface/pipeline.h"

#include <chrono>
#include <cstdio>

namespace quickses {

inline double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

// How far a computation has come, over all attempts.
struct Course {
  uint32_t attempts = 0;  // at the next level
  size_t next = 0;        // levels before it are finished
  bool is_prepared = false;
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();  // of the next level
};

// What a frame is made of, and by which plan.
struct PlannedFrame {
  const FrameInput &in;
  const MemoryPlan &plan;
  Span<const float> spacings;
  bool is_beside;         // whether its levels are made beside each other
  bool first_goes_alone;  // but for the first one, behind which they begin
  uint64_t kind;          // of frames like it (open_counts)
  uint64_t atom_bytes;    // of the host, for the reports
};

template <class Executor, class Timer>
class FrameLevels {
 public:
  using Work = LevelWork<Executor, Timer>;

  // threads: for what is left to the CPU.
  template <class... Arguments>
  explicit FrameLevels(const WorkerThreads &threads, Arguments &&...arguments)
      : executor(std::forward<Arguments>(arguments)...), timer(executor), memory(executor), components(threads) {}

  Executor executor;
  Timer timer;
  MeshMemory<Executor> memory;
  ComponentFinder components;
  LearntRooms<Executor> rooms{};
  Progress progress;
  WorkFacts facts{};  // of the level that is being made; of those beside each other, of what they share

  // Of all levels, to be prepared.
  Work work_of(const FrameInput &in, const MemoryPlan &plan, qses_report *report) {
    return work_of(in.settings, plan, executor, memory, &facts, report);
  }
  // Tables of marching cubes, uploaded once.
  const TableView &table() {
    if (!table_.triangle_count) table_ = memory.upload_table(executor, marching_cubes_table());
    return table_;
  }

  // All levels but those that are finished. check(work, spacing): whether to begin a level; throws if not.
  template <class Check>
  void make(const PlannedFrame &frame, Course *course, LevelSink &sink, const Check &check) {
    double total = 0, begun = 0;
    for (const float h : frame.spacings) total += cost_of(h);
    const auto start = std::chrono::steady_clock::now();
    qses_report report{};
    Work shared = work_of(frame.in, frame.plan, &report);
    const bool is_beside = frame.is_beside;
    const typename CoarseLanes<Executor>::Scope lanes_scope(lanes_, executor);
    if (frame.in.atoms.count > 0) prepare_frame(shared, frame.in);
    if (!course->is_prepared) sink.prepared(milliseconds_since(start));
    course->is_prepared = true;
    if (is_beside) {  // behind that, so that the GPU begins at once
      lanes_.open(executor, frame.spacings, frame.kind, frame.in.settings, sink.stop_flag());
      executor.send_counts();
      lanes_.go_behind(executor);
    }
    Maker maker{*this, frame, course, sink, !is_beside};
    if (!lanes_.know_frames()) maker.verify_prepared();  // they will wait, and note what they count
    LevelsUnderWay<Level, Maker> under_way(maker);
    for (size_t k = 0; k < frame.spacings.size; ++k) {
      const double before = begun;
      begun += cost_of(frame.spacings[k]);
      if (k < course->next) continue;
      const bool is_coarse = k < lanes_.count();
      Executor &own_executor = is_coarse ? lanes_.lane(k).executor : executor;
      MeshMemory<Executor> &own_memory = is_coarse ? lanes_.lane(k).memory : memory;
      sink.give_back();
      if (!is_coarse) maker.verify_prepared();
      own_memory.forget_mesh();
      Level &level = under_way.add(*this, shared, own_executor, own_memory, is_beside);
      level.work.hand_out_others = [&under_way] { under_way.hand_out_others(); };
      if constexpr (Executor::kIsCuda) {
        level.work.attend_to_others = [&under_way] { under_way.attend_to_others(); };
        if (is_beside && frame.first_goes_alone && k > 0) own_executor.go_behind(lanes_.lane(0).executor);
      }
      level.begin = before / total;
      level.end = begun / total;
      maker.begin(level, frame.spacings[k], check);
      under_way.note_begun();
      if (!is_beside) under_way.hand_out_all();
    }
    under_way.hand_out_all();
  }

  // Memory that only levels beside each other have is given up. False: there was none.
  bool drop_lanes() { return lanes_.drop(); }
  // They wait for what they count in the next frame.
  void forget_frames_of_lanes() { lanes_.forget_frames(); }

 private:
  // A level that is under way.
  struct Level {
    // shared: the work on all levels; the executor and memory are those of the level.
    Level(FrameLevels &levels, const Work &shared, Executor &executor, MeshMemory<Executor> &memory, bool is_beside)
        : facts(levels.facts),
          work(levels.work_of(shared.settings, shared.plan, executor, memory, is_beside ? &facts : &levels.facts,
                              &out.report)),
          start(executor.arena().mark()) {
      static_cast<PreparedFrame &>(work) = shared;
      qses_report_init(&out.report);
    }
    FinishedMesh out{};
    WorkFacts facts;  // where it is made beside others
    Work work;
    decltype(std::declval<Executor &>().arena().mark()) start;
    MeshMemoryView mesh{};
    float spacing = 0;
    double begin = 0, end = 0;  // of it, as fractions of all levels
  };

  // What is done for each level.
  struct Maker {
    FrameLevels &levels;
    const PlannedFrame &frame;
    Course *course;
    LevelSink &sink;
    bool is_verified;  // what is prepared for all levels; one after the other verify it with their own counts

    // Before anything that rests on it is looked at; and before the same executor sends counts of the finest level.
    void verify_prepared() {
      if (!is_verified) levels.executor.verify_counts();
      is_verified = true;
    }
    template <class Check>
    void begin(Level &level, float spacing, const Check &check) {
      Work &work = level.work;
      levels.progress.enter(level.begin, level.end);
      levels.progress.report(0.0);
      level.spacing = spacing;
      if (frame.in.atoms.count == 0) return;
      if (work.makes_mesh) {
        work.enter_level(spacing);
        work.executor.turn_counts_to(spacing);
      }
      check(work, spacing);
      level.mesh = begin_level(work);
      work.executor.hand_over();
    }
    void end(Level &level) {
      verify_prepared();
      Work &work = level.work;
      level.out.report.measured_by = measured_by(frame.in);
      levels.progress.enter(level.begin, level.end);
      if (frame.in.atoms.count > 0) level.mesh = end_level(work, level.mesh);
      levels.timer.begin("mesh_memory");
      work.executor.send_counts();
      work.memory.send(&level.mesh);
      work.executor.hand_over();
    }
    bool is_done(const Level &level) const { return level.work.memory.is_done(); }
    void go_on_with(const Level &level) { levels.progress.enter(level.begin, level.end); }
    void hand_out(Level &level) {
      Work &work = level.work;
      FinishedMesh &out = level.out;
      // No lane reads what the finest level's executor has counted any more.
      if (course->next + 1 == frame.spacings.size) work.executor.close_counts();
      work.memory.finish(level.mesh, frame.in.settings, &out);
      levels.timer.end();
      work.executor.verify_counts();
      out.on_host.spacing = out.on_device.mesh.spacing = level.spacing;
      out.report.attempts = course->attempts;
      out.report.compute_ms = milliseconds_since(course->start);
      course->start = std::chrono::steady_clock::now();
      levels.complete(level.mesh, frame, &out.report);
      levels.timer.reset();
      work.executor.arena().rewind(level.start);
      levels.progress.enter(level.begin, level.end);
      levels.progress.report(1.0);
      sink.finished(std::move(out));
      ++course->next;
      course->attempts = 1;
    }
  };

  Work work_of(const qses_settings &settings, const MemoryPlan &plan, Executor &own_executor,
               MeshMemory<Executor> &own_memory, WorkFacts *own_facts, qses_report *report) {
    return {{},      own_executor, timer, own_memory, components, rooms,        progress,
            table(), settings,     plan,  own_facts,  report,     &area_memory_};
  }

  // The work of a level grows with the number of its lattice points at the surface.
  static double cost_of(float spacing) { return 1.0 / (static_cast<double>(spacing) * static_cast<double>(spacing)); }

  // Memory and times of the level that is just finished.
  void complete(const MeshMemoryView &mesh, const PlannedFrame &frame, qses_report *report) {
    report->work_bytes_peak = executor.arena().peak() + memory.outside_arena(executor) + lanes_.work_bytes();
    report->mesh_bytes = frame.in.settings.delivery == QSES_DELIVERY_NONE ? 0 : mesh.bytes;
    report->host_bytes_peak = frame.atom_bytes + components.bytes() + area_memory_.size() + memory.host_bytes() +
                              lanes_.host_bytes() + (Executor::kIsCuda ? 0 : report->work_bytes_peak);
    for (const auto &stage : timer.collect()) {
      if (report->stage_count == QSES_MAX_STAGES) break;
      qses_stage_time &out = report->stages[report->stage_count++];
      std::snprintf(out.name, sizeof out.name, "%s", stage.first);
      out.milliseconds = stage.second;
    }
  }

  CoarseLanes<Executor> lanes_;
  GrowingBuffer<HostMemory> area_memory_;
  TableView table_{};
};

}  // namespace quickses
