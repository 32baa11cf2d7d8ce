// SPDX-License-Identifier: Apache-2.0
#include "core/state/world_state.h"

#include "core/parallel/workers.h"

namespace kiva {

WorldState::WorldState(const WorldDescription& description, const WorldOptions& options)
    : physics(description.gravity),
      view{{{{{{settings, clock, fleet, obstacles, models, storage, floor, physics, people, fallen,
                schedule, plugins, jointed_bodies},
               fleet},
              storage,
              report_link,
              log},
             obstacles,
             models,
             schedule},
            physics,
            contact_log,
            external_inputs},
           settings,
           floor,
           fallen,
           people,
           failures,
           scans} {
  settings.name = description.name;
  settings.gravity = description.gravity;
  settings.options = options;
  settings.realism = options.realism.value_or(Realism());
  clock.dt = description.step_size;
  schedule.workers = std::make_shared<Workers>(options.threads);
  fleet.applyRealism(settings.realism, clock.dt);
}

WorldState::~WorldState() {
  for (auto& model : models) {
    if (model && model->in_physics) physics.remove(model->bodies);
  }
}

}  // namespace kiva
