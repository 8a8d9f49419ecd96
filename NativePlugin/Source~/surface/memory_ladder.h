// SPDX-License-Identifier: MIT
// The engine: walks down the ladder of memory plans (memory/memory_plan.h) until the pipeline fits, and remembers where
// that was. A template over the executor: cpu_engine.cpp and cuda_engine.cu make one of each.
#pragma once

#include "surface/frame_history.h"
#include "surface/frame_levels.h"
#include "surface/methods/size_estimate.h"

#include <cstring>

namespace quickses {

// Where the pipeline is only counted, nobody is told the time.
struct NoTimer {
  bool is_enabled() const { return false; }
  void begin(const char *) {}
};

template <class Executor, class Timer>
class LadderEngine : public SurfaceEngine {
 public:
  // memory_budget: bytes, 0 for none. threads: for what is left to the CPU.
  template <class... Arguments>
  LadderEngine(uint64_t memory_budget, const WorkerThreads &threads, Arguments &&...arguments)
      : levels_(threads, std::forward<Arguments>(arguments)...), budget_(memory_budget) {
    // What is held outside of the arena is taken off; the least budget is one that is surely too small.
    const uint64_t outside = memory_.allowed_outside(executor_);
    if (budget_ > 0) executor_.arena().set_budget(budget_ > outside + 4096 ? budget_ - outside : 4096);
  }

  std::shared_ptr<AtomSet> make_atoms(size_t count) override {
    const typename Executor::CallScope scope(executor_);
    return atoms_.make(count);
  }

  void compute(const AtomSet &atoms, const Appearance &appearance, const qses_settings &settings,
               Span<const float> spacings, LevelSink &sink) override {
    levels_.progress.restart(&sink.stop_flag(), [&sink](double fraction) { sink.advance(fraction); });
    const FrameInput in{atoms, appearance, settings};
    Course course;
    const auto attempt = [&](const MemoryPlan &plan) {
      const uint32_t attempts = course.attempts++;
      if (attempts == 0) expect_memory(in);
      executor_.open_counts(may_anticipate(in, plan) ? kind_of(in) : 0, history_.takes_less_than(kShortFrame));
      try {
        is_beside_ = may_be_beside(in, plan, spacings);
        const PlannedFrame frame{
            in, plan, spacings, is_beside_, history_.takes_more_than(first_alone), kind_of(in), atoms_.bytes()};
        levels_.make(frame, &course, sink, [&](Work &work, float spacing) {
          spacing_ = spacing;
          if (work.makes_mesh) check_forecast(work, in, &plan == &last_plan(in));
        });
      } catch (const AnticipatedTooLittle &) {
        course.attempts = attempts;
        throw;
      }
    };
    const auto start = std::chrono::steady_clock::now();
    history_.begin(settings, spacings);
    walk(in, sink.stop_flag(), attempt);
    history_.end(milliseconds_since(start));
    if (makes_mesh(in) && is_exact(settings) && spacing_ == settings.spacing) learnt_.has_made_mesh = true;
  }

  qses_size_estimate estimate(const AtomSet &atoms, const Appearance &appearance, const qses_settings &settings,
                              const std::atomic<bool> &stop) override {
    levels_.progress.restart(nullptr, {});
    qses_size_estimate out;
    qses_size_estimate_init(&out);
    out.fits = 1;
    if (atoms.count == 0) return out;
    const FrameInput in{atoms, appearance, settings};
    double growth = 1, hard_part = 0;
    const typename Executor::CallScope scope(executor_);
    walk(in, stop, [&](const MemoryPlan &plan) {
      executor_.open_counts(0);
      qses_report report{};
      Work work = levels_.work_of(in, plan, &report);
      prepare_frame(work, in);
      if (work.makes_mesh) {
        work.enter_level(settings.spacing);
        if (is_exact(settings)) facts_.caps = count_kept_caps(work);
        count(work);
        if (splits_creases(work)) growth += expected_splits(work).added;
        if (work.hard_edges) hard_part = expected_hard_part(work);
      }
      executor_.arena().reset();
    });
    const uint64_t limit = executor_.arena().limit(), least = least_bytes(in);
    uint64_t whole = forecast(in, kMemoryPlans[0], limit);
    if (whole > limit) whole = std::max(least, limit);
    MeshShape shape = shape_of(settings, !appearance.colors.empty());
    shape.repeated = static_cast<size_t>(hard_part * growth * facts_.size.vertices);
    if (Executor::kIsCuda) shape.owners = !leaves_owners(settings);
    out.vertices = static_cast<uint64_t>(growth * facts_.size.vertices) + shape.repeated;
    out.triangles = static_cast<uint64_t>(growth * facts_.size.triangles);
    if (settings.delivery != QSES_DELIVERY_NONE)
      out.mesh_bytes = MeshArrays(out.vertices, out.triangles, shape).bytes();
    out.work_bytes = whole + memory_.outside_arena(executor_);
    out.smallest_budget = least + memory_.needed_outside(executor_);
    // Without a budget a mesh on the CPU takes of what is free as well.
    const uint64_t beside = budget_ > 0 || Executor::kIsCuda ? 0 : out.mesh_bytes;
    const bool can_be_numbered = out.vertices <= kMostNumbered && out.triangles <= kMostNumbered;
    out.fits = can_be_numbered && out.smallest_budget + beside <= (budget_ > 0 ? budget_ : limit) ? 1 : 0;
    return out;
  }

  void enable_stage_times(bool enabled) override {
    takes_times_ = enabled;
    levels_.timer.enable(enabled);
  }
  void set_progress(std::function<void(double)> progress) override { levels_.progress.set(std::move(progress)); }

 private:
  using Work = typename FrameLevels<Executor, Timer>::Work;
  static constexpr uint64_t kUnlimited = ~uint64_t(0) >> 1;
  // The next one may be queued as a whole: nobody who cancels it waits longer.
  static constexpr double kShortFrame = 100;  // ms
  // Of predictions that rest on a predicted size: sizes are known to some per cent.
  static constexpr double kMargin = 1.02;
  static constexpr uint64_t kSpareBytes = 32768;

  // ---- the ladder ----------------------------------------------------------------------------------------------

  // Calls attempt(plan) with one plan after the other, from the one that did last time, until none is refused memory.
  template <class Attempt>
  void walk(const FrameInput &in, const std::atomic<bool> &stop, const Attempt &attempt) {
    const typename Executor::CallScope scope(executor_);
    const typename Executor::RunScope run_scope(executor_, stop);
    memory_.deliver_to(in.settings);
    executor_.arena().reset();  // what is free is asked anew
    bool has_dropped = false;
    for (size_t step = first_step(in);; executor_.arena().reset()) {
      levels_.timer.reset();
      facts_ = {};
      facts_.atoms = in.atoms.count;
      facts_.found = learnt_.found;
      spacing_ = in.settings.spacing;
      is_beside_ = false;
      try {
        attempt(kMemoryPlans[step]);
        note_splits();
        return;
      } catch (const AnticipatedTooLittle &) {  // the same again: who anticipated too little waits for all counts now
        levels_.forget_frames_of_lanes();       // which may rest on that
      } catch (const MemoryRefused &refused) {
        if (!will_do_better(refused, &has_dropped)) step = next_step(in, step);
        if (step < plan_count(in)) continue;
        name_smallest_budget(in);
        throw;
      }
    }
  }

  // Those that there are for this delivery: a mesh that is in pieces can't stay on the device.
  static size_t plan_count(const FrameInput &in) {
    const auto makes_pieces = [](const MemoryPlan &plan) { return plan.mesh_in_pieces; };
    const MemoryPlan *const end = kMemoryPlans + kMemoryPlanCount;
    return static_cast<size_t>(
        (is_for_device(in.settings.delivery) ? std::find_if(kMemoryPlans, end, makes_pieces) : end) - kMemoryPlans);
  }
  static const MemoryPlan &last_plan(const FrameInput &in) { return kMemoryPlans[plan_count(in) - 1]; }

  // Whether something was changed, or learnt, that makes the plan that was refused worth another attempt. has_dropped:
  // what was kept outside of the arena.
  bool will_do_better(const MemoryRefused &refused, bool *has_dropped) {
    const bool had_lanes = levels_.drop_lanes(), lacked_room = facts_.found.lacked_room;
    note_splits();
    if (is_beside_) {
      note_loneliness();  // one level after the other
      return true;
    }
    if (had_lanes) {
      history_.unsettle();  // with what they had
      return true;
    }
    if (executor_.has_anticipated()) {
      note_tightness();  // without the room for more than there is
      return true;
    }
    if (lacked_room) return true;  // with as much behind the mesh as splits of creases need
    if (!*has_dropped && memory_.drop_kept_outside(executor_)) {
      *has_dropped = true;  // without what a crowded frame before it has left
      return true;
    }
    return refused.again();
  }

  // Whether a frame may go on with what was counted in the one before: where there is room for more than is needed, and
  // arcs are only looked for, not gone through (as they are where the surface is that of the balls, to be measured).
  bool may_anticipate(const FrameInput &in, const MemoryPlan &plan) {
    return plan.single_slice && budget_ == 0 && !learnt_.is_tight && in.settings.slice_size == 0 &&
           is_exact(in.settings) && !parameters_of(in).is_of_balls() && !levels_.progress.wanted();
  }
  // Whether the levels of a ladder are made beside each other: where none is expected to wait.
  bool may_be_beside(const FrameInput &in, const MemoryPlan &plan, Span<const float> spacings) {
    return Executor::kIsCuda && spacings.size > 1 && in.atoms.count > 0 && !takes_times_ && may_anticipate(in, plan) &&
           history_.is_settled() && !learnt_.is_lone && history_.takes_less_than(short_ladder);
  }
  // What frames have in common whose counts are much the same. Never 0.
  uint64_t kind_of(const FrameInput &in) const {
    const SurfaceParameters p = parameters_of(in);
    const float numbers[] = {p.max_radius, p.probe, p.depth};
    uint32_t words[3];
    static_assert(sizeof numbers == sizeof words, "one word each");
    std::memcpy(words, numbers, sizeof words);
    uint64_t kind = in.atoms.count;
    for (const uint32_t word : words) kind = kind * 0x9e3779b97f4a7c15u + word;
    return kind | 1;
  }

  // Where the ladder begins: at the top, or where it ended for as many atoms of the same size with no more memory.
  size_t first_step(const FrameInput &in) {
    const SurfaceParameters p = parameters_of(in);
    if (in.atoms.count != learnt_.atoms || p.max_radius != learnt_.reach) levels_.rooms.forget();
    if (in.atoms.count != learnt_.atoms || p.max_radius != learnt_.reach || p.spacing != learnt_.spacing) {
      forget();
      learnt_.atoms = in.atoms.count;
      learnt_.reach = p.max_radius;
      learnt_.spacing = p.spacing;
    }
    const bool had_too_little = learnt_.step > 0 || learnt_.is_tight || learnt_.is_lone;
    if (had_too_little && executor_.arena().share() > learnt_.share / 4 * 5) {
      learnt_.step = 0;
      learnt_.is_tight = learnt_.is_lone = false;
    }
    return std::min(learnt_.step, plan_count(in) - 1);
  }

  void forget() {
    learnt_ = {};
    history_.forget();
  }

  void note_tightness() {
    executor_.arena().release();
    learnt_.is_tight = true;
    learnt_.share = executor_.arena().share();
  }

  void note_splits() {
    learnt_.found = facts_.found;
    learnt_.found.lacked_room = false;
  }

  void note_loneliness() {
    executor_.arena().reset();  // what is free is asked anew
    learnt_.is_lone = true;
    learnt_.share = executor_.arena().share();
  }

  // Memory was refused: whatever was taken is given back, so that it is known how much there is, and plans that are
  // forecast to take more are passed over.
  size_t next_step(const FrameInput &in, size_t step) {
    if (budget_ == 0) executor_.arena().release();
    const uint64_t limit = executor_.arena().limit();
    for (++step; step + 1 < plan_count(in) && knows_size(); ++step)
      if (forecast(in, kMemoryPlans[step], limit) <= limit) break;
    learnt_.step = std::min(step, plan_count(in) - 1);
    learnt_.share = executor_.arena().share();
    learnt_.has_made_mesh = false;
    history_.forget();
    return step;
  }

  // ---- forecasts -----------------------------------------------------------------------------------------------

  // Before time is spent on a plan that won't do, or on a spacing that is hopelessly fine. Where a plan did for a mesh
  // of such atoms before, nothing is predicted.
  void check_forecast(Work &work, const FrameInput &in, bool is_last) {
    auto &arena = executor_.arena();
    const bool is_fine = work.parameters.spacing < kCheckedSpacing, is_short = arena.has_budget() || learnt_.share > 0;
    if (learnt_.has_made_mesh || !is_exact(in.settings) || !(is_fine || is_short)) return;
    uint64_t needed = 0;
    const auto is_too_large = [&] {
      needed = forecast(in, work.plan, arena.limit());
      return static_cast<double>(needed) > kMemoryCertainty * static_cast<double>(arena.limit());
    };
    facts_.size = predict_size(work);
    if (is_short && is_too_large()) {
      // So roughly predicted, an atom alone among large probes has far too much surface: there is no further plan.
      if (is_last) count(work);
      if (!is_last || is_too_large())
        throw MemoryRefused("the surface is forecast to need about " + describe_bytes(needed) +
                            " of memory for the work, but " + describe_bytes(arena.limit()) +
                            " are available: a larger spacing needs less");
    }
    if (!is_fine) return;
    const MeshArrays mesh(static_cast<size_t>(facts_.size.vertices), static_cast<size_t>(facts_.size.triangles),
                          work.shape);
    const uint64_t whole = forecast(in, kMemoryPlans[0], kUnlimited) + (Executor::kIsCuda ? 0 : mesh.bytes());
    refuse_hopeless_spacing(static_cast<double>(work.parameters.spacing), facts_.size, static_cast<double>(whole),
                            arena.has_budget() ? 0.0 : static_cast<double>(arena.limit()));
  }

  void count(Work &work) {
    facts_.size = estimate_size(work);
    if (!work.settings.occlusion) return;
    const auto mark = executor_.arena().mark();
    facts_.occlusion_bricks = find_occlusion_bricks(work).count;
    executor_.arena().rewind(mark);
  }

  bool knows_size() const { return facts_.size.vertices > 0; }

  // Bytes of the arena, and of a mesh that stays on the device, that a plan takes, if the sizes are as the facts say:
  // the pipeline, only counted.
  uint64_t forecast(const FrameInput &in, const MemoryPlan &plan, uint64_t limit) {
    using Counting = CountingExecutor<Executor>;
    Counting counted(executor_, facts_, limit, executor_.arena().has_budget());
    MeshMemory<Counting> memory(is_for_device(in.settings.delivery));
    ComponentFinder components(1);
    NoTimer timer;
    Progress progress;
    WorkFacts facts;  // the work finds out the others
    facts.found = facts_.found;
    qses_report report;
    qses_report_init(&report);
    const TableView no_table{};
    LevelWork<Counting, NoTimer> work{{},       counted,  timer,       memory, components, levels_.rooms,
                                      progress, no_table, in.settings, plan,   &facts,     &report};
    prepare_frame(work, in);
    if (work.makes_mesh) work.enter_level(spacing_);
    end_level(work, quickses::begin_level(work));
    return counted.arena().peak() + memory.kept();
  }

  uint64_t least_bytes(const FrameInput &in) {
    const uint64_t bytes = forecast(in, last_plan(in), kUnlimited);
    return static_cast<uint64_t>(kMargin * static_cast<double>(bytes)) + kSpareBytes;
  }

  // What is not known of the finest level, guessed.
  void guess_facts(const FrameInput &in) {
    const SurfaceParameters parameters = parameters_of(in);
    double most_bricks = 1;
    if (makes_mesh(in)) {  // else no spacing is too fine
      Lattice lattice = center_lattice(in.atoms.bounds, frame_spacing(levels_of(in.settings)));
      const glm::vec3 low = to_glm(lattice.from_caller(&in.atoms.bounds.low.x)),
                      high = to_glm(lattice.from_caller(&in.atoms.bounds.high.x));
      lattice.spacing = parameters.spacing;
      most_bricks = static_cast<double>(layout_lattice(lattice, low, high, parameters.max_radius).table_size());
    }
    if (spacing_ != in.settings.spacing) facts_.size = {};  // those of a coarser level
    spacing_ = in.settings.spacing;
    guess_unknown(parameters, is_exact(in.settings), most_bricks, &facts_);
  }

  // Of a first computation. The guess is generous: proteins take three quarters of it, or less.
  void expect_memory(const FrameInput &in) {
    auto &arena = executor_.arena();
    if (arena.held() > 0 || arena.has_budget() || in.atoms.count == 0) return;
    const WorkFacts known = facts_;
    try {
      guess_facts(in);
      arena.expect(forecast(in, kMemoryPlans[0], arena.limit()) / 4 * 3);
    } catch (const Error &) {  // so fine a level is refused when it comes to it
    }
    facts_ = known;
  }

  // No plan was left. With a budget the user is told which one would do, as far as that is known by now.
  void name_smallest_budget(const FrameInput &in) {
    if (budget_ == 0) return;
    const FoundSplits &found = facts_.found;
    const bool knows_splits = !in.settings.creases || (found.near > 0 && (!in.settings.hard_edges || found.crest > 0));
    const bool is_counted = knows_size() && spacing_ == in.settings.spacing && knows_splits;
    guess_facts(in);
    const uint64_t least = least_bytes(in) / 10 * (is_counted ? 10 : 11) + memory_.needed_outside(executor_);
    throw Error(QSES_OUT_OF_MEMORY, "the memory budget of " + describe_bytes(budget_) +
                                        " does not suffice for this surface: about " +
                                        describe_bytes(std::max(least, budget_ + budget_ / 8)) +
                                        (is_counted ? " would" : " may") + " do, or a larger spacing");
  }

  FrameLevels<Executor, Timer> levels_;
  Executor &executor_ = levels_.executor;
  MeshMemory<Executor> &memory_ = levels_.memory;
  WorkFacts &facts_ = levels_.facts;
  AtomPool<typename Executor::HostSource> atoms_;
  uint64_t budget_;
  bool takes_times_ = false;  // of stages, whose levels are not made beside each other
  bool is_beside_ = false;    // whether those of this frame are
  // Of the last computation of so many atoms with this largest inflated radius and finest spacing: where the ladder
  // ended, with how much memory, whether there was too little for what frames anticipate, or for levels beside each
  // other, whether that did for an exact mesh of that spacing; and what splits of creases found.
  struct Learnt {
    size_t atoms = 0;
    float reach = 0, spacing = 0;
    size_t step = 0;
    uint64_t share = 0;
    bool is_tight = false, is_lone = false, has_made_mesh = false;
    FoundSplits found{};
  } learnt_;
  FrameHistory history_;
  float spacing_ = 0;  // of the level that is being made
};

}  // namespace quickses
