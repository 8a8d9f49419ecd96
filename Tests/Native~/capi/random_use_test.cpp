// SPDX-License-Identifier: MIT
// Whatever calls come in whatever order, on a few contexts and kept meshes at once, with jobs in the background:
// statuses are those of the header, every mesh is, byte for byte, the one that a fresh context makes of the same
// request, and what was handed out or kept stays as it was. The calls are a matter of the seed alone.
//   QUICKSES_PROPERTY_SETS  number of sequences; default 100
//   QUICKSES_PROPERTY_SEED  the first of their seeds; default 1
//   QUICKSES_PROPERTY_CALLS of each sequence; default 60. Fewer of them are the same ones
#include "capi/random_use_model.h"

using namespace random_use;

namespace {

#ifdef QUICKSES_PROPERTY_DEFAULT_SETS  // of builds with sanitizers, which are slow
constexpr uint64_t kDefaultSets = QUICKSES_PROPERTY_DEFAULT_SETS;
#else
constexpr uint64_t kDefaultSets = 100;
#endif

class Sequence {
 public:
  explicit Sequence(uint64_t seed) : random_(seed) {
    for (size_t k = 0; k < contexts_.size(); ++k) make_context(k);
  }
  ~Sequence() { finish(); }

  // Does something, whatever comes next.
  void step() {
    const size_t c = static_cast<size_t>(random_.below(contexts_.size()));
    const size_t k = static_cast<size_t>(random_.below(kept_.size()));
    const uint64_t kind = random_.below(100);
    log_ += "\n  context " + std::to_string(c) + ": ";
    ContextModel &context = *contexts_[c];
    if (kind < 11)
      set_atoms(context);
    else if (kind < 17)
      set_positions(context);
    else if (kind < 22)
      set_appearance(context);
    else if (kind < 38)
      begin(context);
    else if (kind < 46)
      compute(context);
    else if (kind < 50)
      estimate(context);
    else if (kind < 63)
      note("collect"), context.collect();
    else if (kind < 68)
      wait(context);
    else if (kind < 72)
      note("cancel"), context.cancel();
    else if (kind < 75)
      note("poll"), context.check_progress();
    else if (kind < 79)
      disturb(context);
    else if (kind < 82)
      pass_barrier(context);
    else if (kind < 88)
      note("keep in " + std::to_string(k)), context.keep(kept_[k].get());
    else if (kind < 96)
      use_kept(k);
    else if (kind < 97)
      note("stage times"), context.set_stage_times(random_.chance(0.5));
    else if (kind < 98)
      note("component atoms"), context.check_component_atoms();
    else if (kind < 99)
      note("held mesh"), context.check_held();
    else
      make_context(c);
  }

  // All comes to its end.
  void finish() {
    for (auto &context : contexts_) {
      if (!context) continue;
      context->disturb_no_more();
      context->wait(-1);
      context->collect();
      context->check_held();
      context.reset();
    }
    for (size_t k = 0; k < kept_.size(); ++k) {
      kept_[k]->wait_for_reader();
      EXPECT_EQ(kept_[k]->fault(), "") << "kept mesh " << k;
    }
  }

  const std::string &log() const { return log_; }

 private:
  void note(const std::string &words) { log_ += words; }

  void make_context(size_t k) {
    std::string what;
    contexts_[k].reset();
    contexts_[k] = std::make_unique<ContextModel>(random_, &last_tag_, &what);
    note("\n  new context " + std::to_string(k) + ", " + what);
  }

  void set_atoms(ContextModel &context) {
    Frame frame;
    frame.is_wide = random_.chance(0.1);
    frame.atoms = random_atoms(random_);
    const bool is_as_many = random_.chance(0.3);
    if (frame.is_wide) frame.atoms = wide_atoms();
    if (is_as_many && !frame.is_wide && context.frame()) {
      frame = *context.frame();
      for (float &r : frame.atoms.radii) r = static_cast<float>(random_.uniform(1, 2));
    }
    const bool is_spoilt = random_.chance(0.25) && frame.atoms.size() > 0;
    note("set_atoms, " + std::to_string(frame.atoms.size()) + (is_spoilt ? ", not allowed" : ""));
    if (is_spoilt) spoil(&frame.atoms, random_);
    const Atoms &a = frame.atoms;
    context.expect(qses_set_atoms(context.get(), a.positions.data(), 0, a.radii.data(), a.size()),
                   is_spoilt ? QSES_INVALID_ARGUMENT : QSES_OK);
    if (is_spoilt) return;
    if (context.frame() && context.frame()->atoms.size() == a.size()) {  // they look as before
      const Frame &before = *context.frame();
      frame.visible = before.visible, frame.colors = before.colors, frame.texcoords = before.texcoords;
    }
    context.now_has(std::make_shared<Frame>(frame));
  }

  void set_positions(ContextModel &context) {
    const bool is_indexed = random_.chance(0.4), is_spoilt = random_.chance(0.15), is_count_wrong = random_.chance(0.1);
    note(std::string("set_positions") + (is_indexed ? "_indexed" : "") + (is_spoilt ? ", not allowed" : "") +
         (is_count_wrong ? ", another count" : ""));
    if (!context.frame()) {
      const float p[3] = {0, 0, 0};
      return context.expect(qses_set_positions(context.get(), p, 0, 1), QSES_NO_ATOMS);
    }
    Frame frame = *context.frame();
    frame.atoms = moved(frame.atoms, random_);
    const size_t atoms = frame.atoms.size(), count = atoms + (is_count_wrong ? 1 : 0);
    const bool is_good = !is_count_wrong && (!is_spoilt || atoms == 0);
    std::vector<float> positions = frame.atoms.positions;
    positions.resize(3 * count);
    if (is_spoilt && atoms > 0) positions[3 * static_cast<size_t>(random_.below(atoms))] = kNan;
    const qses_status expected = is_good ? QSES_OK : QSES_INVALID_ARGUMENT;
    if (is_indexed) {  // backwards, with others between them
      std::vector<float> all(6 * count, kNan);
      std::vector<uint32_t> indices(count);
      for (size_t i = 0; i < count; ++i) {
        indices[i] = static_cast<uint32_t>(2 * (count - 1 - i));
        std::copy_n(&positions[3 * i], 3, &all[3 * size_t(indices[i])]);
      }
      context.expect(qses_set_positions_indexed(context.get(), all.data(), 0, 2 * count, indices.data(), count),
                     expected);
    } else {
      context.expect(qses_set_positions(context.get(), positions.data(), 0, count), expected);
    }
    if (is_good) context.now_has(std::make_shared<Frame>(frame));
  }

  void set_appearance(ContextModel &context) {
    const uint64_t which = random_.below(3);
    const bool is_default = random_.chance(0.3), is_count_wrong = random_.chance(0.1);
    const unsigned seed = static_cast<unsigned>(random_.below(1000));
    note("appearance " + std::to_string(which) + (is_default ? ", default" : "") +
         (is_count_wrong ? ", another count" : ""));
    Frame frame = context.frame() ? *context.frame() : Frame();
    const size_t atoms = frame.atoms.size(), count = atoms + (is_count_wrong ? 1 : 0);
    const std::vector<uint8_t> bytes = some_visible(4 * count, seed);
    const std::vector<float> floats(2 * count, static_cast<float>(seed));
    const uint8_t *const some = is_default ? nullptr : bytes.data();
    const qses_status status = which == 0 ? qses_set_visible(context.get(), some, count)
                               : which == 1
                                   ? qses_set_colors(context.get(), some, count)
                                   : qses_set_texcoords(context.get(), is_default ? nullptr : floats.data(), count);
    context.expect(status, !context.frame() ? QSES_NO_ATOMS : is_count_wrong ? QSES_INVALID_ARGUMENT : QSES_OK);
    if (!context.frame() || is_count_wrong) return;
    const size_t used = is_default ? 0 : count;
    if (which == 0)
      frame.visible.assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(used));
    else if (which == 1)
      frame.colors.assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(4 * used));
    else
      frame.texcoords.assign(floats.begin(), floats.begin() + static_cast<std::ptrdiff_t>(2 * used));
    context.now_has(std::make_shared<Frame>(frame));
  }

  // is_good: null where they have to be.
  qses_settings some_settings(ContextModel &context, bool *is_good) {
    qses_settings s = good_settings(random_, context.frame().get());
    if (is_good) *is_good = !random_.chance(0.12);
    note(" " + in_words(s) + (is_good && !*is_good ? ", spoilt" : ""));
    if (is_good && !*is_good) spoil(&s, random_);
    return s;
  }

  void begin(ContextModel &context) {
    bool is_good = false;
    note("begin " + std::to_string(last_tag_ + 1) + ":");
    const qses_settings s = some_settings(context, &is_good);
    context.begin(s, is_good);
  }

  void compute(ContextModel &context) {
    bool is_good = false;
    note("compute " + std::to_string(last_tag_ + 1) + ":");
    const qses_settings s = some_settings(context, &is_good);
    context.compute(s, is_good, random_.chance(0.7));
  }

  void estimate(ContextModel &context) {
    bool is_good = false;
    note("estimate");
    const qses_settings s = some_settings(context, &is_good);
    context.estimate(s, is_good);
  }

  void wait(ContextModel &context) {
    const double times[] = {0, 0.05, 1, -1, 1e300};
    const double milliseconds = random_.any_of(times);
    note("wait " + std::to_string(milliseconds));
    context.wait(milliseconds);
    context.expect(qses_wait(context.get(), static_cast<double>(kNan), nullptr), QSES_INVALID_ARGUMENT);
  }

  void disturb(ContextModel &context) {
    const int times = static_cast<int>(random_.count(1, 20));
    const bool is_end = random_.chance(0.4), cancels = random_.chance(0.7);
    note(is_end ? "disturb no more" : cancels ? "cancels on another thread" : "polls on another thread");
    if (is_end)
      context.disturb_no_more();
    else
      context.disturb(times, cancels);
  }

  void pass_barrier(ContextModel &context) {
    const bool has_second = random_.chance(0.6);
    const auto cancelled = static_cast<ContextModel::Cancel>(random_.below(3));
    const char *const words[] = {"held, ", "held and cancelled, ", "held and cancelled with the next one, "};
    note(words[static_cast<int>(cancelled)] + std::to_string(last_tag_ + 1) + ":");
    const qses_settings first = some_settings(context, nullptr), second = some_settings(context, nullptr);
    if (context.frame()) context.pass_barrier(first, has_second ? &second : nullptr, cancelled);
  }

  void use_kept(size_t k) {
    KeptModel &kept = *kept_[k];
    const uint64_t kind = random_.below(8), where = random_.below(1u << 20);
    note("kept mesh " + std::to_string(k) + ", " + std::to_string(kind));
    if (kind == 0) {
      kept.wait_for_reader();
      qses_kept_mesh_clear(kept.kept);
      kept.is_full = false;
    } else if (kind == 1) {
      kept.wait_for_reader();
      kept.reader = std::async(std::launch::async, [&kept] { return kept.fault(); });
    } else if (kind == 2) {
      kept.wait_for_reader();
      EXPECT_EQ(qses_kept_mesh_download(kept.kept), kept.is_full ? QSES_OK : QSES_NO_RESULT);
    } else if (kind < 5) {
      paint(kept, static_cast<uint32_t>(where));
    } else if (kind < 7) {
      filter_and_pick(kept, static_cast<uint32_t>(where));
    }
    EXPECT_EQ(kept.fault(), "") << "kept mesh " << k;
  }

  void paint(KeptModel &kept, uint32_t where) {
    const qses_mesh m = kept.kept.view();
    const uint32_t first = where % (m.vertex_count + 1), count = m.vertex_count - first;
    std::vector<uint32_t> per_atom(kept.atom_count + 1), per_vertex(size_t(count) + 1);
    for (size_t i = 0; i < per_atom.size(); ++i) per_atom[i] = static_cast<uint32_t>(i) * 2654435761u + where;
    const auto painted = [&](size_t atoms, uint32_t more) {
      return qses_kept_mesh_paint(kept.kept, per_atom.data(), 4, atoms, first, count + more, per_vertex.data());
    };
    if (!kept.is_full) return;
    EXPECT_EQ(painted(kept.atom_count + 1, 0), QSES_INVALID_ARGUMENT);
    EXPECT_EQ(painted(kept.atom_count, 1), QSES_INVALID_ARGUMENT);
    const qses_status status = painted(kept.atom_count, 0);
    EXPECT_EQ(status, kept.has_owners ? QSES_OK : QSES_INVALID_ARGUMENT) << qses_last_error();
    for (uint32_t v = 0; v < count && status == QSES_OK; ++v)
      ASSERT_EQ(per_vertex[v], per_atom[m.owners[first + v]]) << v;
  }

  void filter_and_pick(KeptModel &kept, uint32_t where) {
    const qses_mesh m = kept.kept.view();
    if (!kept.is_full || m.triangle_count == 0 || m.vertex_bytes) return;
    const std::vector<uint8_t> visible = some_visible(kept.atom_count, where);
    std::vector<uint32_t> left(3 * size_t(m.triangle_count)), expected;
    uint32_t triangles = 0;
    const qses_status good = kept.has_owners ? QSES_OK : QSES_INVALID_ARGUMENT;
    EXPECT_EQ(
        qses_kept_mesh_filter(kept.kept, visible.data(), kept.atom_count, 0, m.triangle_count, left.data(), &triangles),
        good);
    const uint32_t target = where % m.triangle_count;
    float origin[3] = {0, 0, 0}, direction[3] = {0, 0, 0};
    for (int d = 0; d < 3; ++d) {
      origin[d] = m.bounds_max[d] + 5;
      for (int c = 0; c < 3; ++c)
        direction[d] += m.positions[3 * size_t(m.indices[3 * size_t(target) + size_t(c)]) + size_t(d)] / 3;
      direction[d] -= origin[d];
    }
    qses_hit hit;
    qses_hit_init(&hit);
    EXPECT_EQ(qses_kept_mesh_pick(kept.kept, origin, direction, nullptr, 0, &hit), good);
    if (!kept.has_owners) return;
    for (uint32_t t = 0; t < m.triangle_count; ++t)
      if (is_shown(m, t, visible.data()))
        expected.insert(expected.end(), m.indices + 3 * size_t(t), m.indices + 3 * size_t(t) + 3);
    left.resize(3 * size_t(triangles));
    EXPECT_EQ(left, expected);
    if (m.bounds_max[0] - m.bounds_min[0] > 1e3f) return;  // rays so long may miss
    ASSERT_TRUE(hit.found);
    const uint32_t *const corner = m.indices + 3 * size_t(hit.triangle);
    ASSERT_TRUE(hit.vertex == corner[0] || hit.vertex == corner[1] || hit.vertex == corner[2]);
    EXPECT_EQ(hit.owner, m.owners[hit.vertex]);
    EXPECT_LE(hit.distance, 1.001f);
  }

  Random random_;
  std::string log_;
  uint32_t last_tag_ = 0;
  std::array<std::unique_ptr<KeptModel>, 3> kept_{std::make_unique<KeptModel>(), std::make_unique<KeptModel>(),
                                                  std::make_unique<KeptModel>()};
  std::array<std::unique_ptr<ContextModel>, 3> contexts_;
};

TEST(RandomUse, KeepsToTheHeader) {
  const uint64_t first = properties::number_from_environment("QUICKSES_PROPERTY_SEED", 1),
                 sets = properties::number_from_environment("QUICKSES_PROPERTY_SETS", kDefaultSets),
                 calls = properties::number_from_environment("QUICKSES_PROPERTY_CALLS", 60);
  for (uint64_t seed = first; seed < first + sets && !HasFailure(); ++seed) {
    Sequence sequence(seed);
    try {
      for (uint64_t k = 0; k < calls && !HasFailure(); ++k) sequence.step();
      if (!HasFailure()) sequence.finish();
    } catch (const std::exception &e) {
      ADD_FAILURE() << e.what();
    }
    if (HasFailure()) ADD_FAILURE() << "seed " << seed << ", the last of these calls:" << sequence.log();
  }
}

}  // namespace
