#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Independent PPO in one file, as CleanRL writes it, in PyTorch, on RWARE's task: each robot is a
row of the batch, all share one network. It needs torch, gymnasium, and the wheel (or
. devel/setup.bash).

examples/cleanrl_ppo.py [TASK] [STEPS]     tiny-2ag, 2,000,000 steps of the environments

examples/rware_train.py trains the same without PyTorch.
"""

import sys
import time

import gymnasium
import numpy as np
import torch
from gymnasium.vector import AutoresetMode
from torch import nn

import warehouse_learning.rware  # noqa: F401  registers the tasks

ENVIRONMENTS, ROLLOUT, EPOCHS, MINIBATCHES = 64, 128, 4, 4
RATE, DISCOUNT, TRACE, CLIP, ENTROPY = 7e-4, 0.99, 0.95, 0.2, 0.01


class Agent(nn.Module):
    def __init__(self, size):
        super().__init__()
        self.actor = self._network(size, 5)
        self.critic = self._network(size, 1)

    @staticmethod
    def _network(size, outputs):
        return nn.Sequential(
            nn.Linear(size, 64), nn.Tanh(), nn.Linear(64, 64), nn.Tanh(), nn.Linear(64, outputs)
        )

    def act(self, observation):
        chances = torch.distributions.Categorical(logits=self.actor(observation))
        action = chances.sample()
        return action, chances.log_prob(action), self.critic(observation).squeeze(-1)

    def judge(self, observation, action):
        chances = torch.distributions.Categorical(logits=self.actor(observation))
        return chances.log_prob(action), chances.entropy(), self.critic(observation).squeeze(-1)


def main():
    task = sys.argv[1] if len(sys.argv) > 1 else "tiny-2ag"
    steps = int(sys.argv[2]) if len(sys.argv) > 2 else 2_000_000
    torch.manual_seed(0)
    torch.set_num_threads(1)
    envs = gymnasium.make_vec(
        f"kiva-rware-{task}-v2",
        num_envs=ENVIRONMENTS,
        threads=1,
        autoreset_mode=AutoresetMode.SAME_STEP,
    )
    agent = Agent(envs.single_observation_space.shape[-1])
    adam = torch.optim.Adam(agent.parameters(), lr=RATE, eps=1e-5)
    observation = torch.from_numpy(envs.reset(seed=0)[0])
    returns, finished, begin = np.zeros(ENVIRONMENTS), [], time.process_time()
    for done in range(0, steps, ENVIRONMENTS * ROLLOUT):
        rows = []
        for _ in range(ROLLOUT):
            with torch.no_grad():
                action, log, value = agent.act(observation)
            ahead, reward, ends, _, _ = envs.step(action.numpy())
            returns += reward.sum(1)
            finished += returns[ends].tolist()
            returns[ends] = 0
            end = torch.from_numpy(ends)[:, None].expand(value.shape)
            rows.append((observation, action, log, value, torch.from_numpy(reward).float(), end))
            observation = torch.from_numpy(ahead)
        batch = [torch.stack(parts) for parts in zip(*rows)]
        with torch.no_grad():
            last = agent.critic(observation).squeeze(-1)
        learn(agent, adam, *batch, last)
        if finished:
            rate = (done + ENVIRONMENTS * ROLLOUT) / (time.process_time() - begin)
            print(f"{done:,} steps: return {np.mean(finished):.2f}; {rate:,.0f} a second of CPU")
            finished = []


def learn(agent, adam, observation, action, log, value, reward, end, last):
    advantage, trace = torch.empty_like(reward), 0.0
    for t in reversed(range(len(reward))):
        following = last if t == len(reward) - 1 else value[t + 1]
        goes_on = 1.0 - end[t].float()
        error = reward[t] + DISCOUNT * following * goes_on - value[t]
        advantage[t] = trace = error + DISCOUNT * TRACE * goes_on * trace
    target = (advantage + value).flatten()
    observation, action, log = observation.flatten(0, 2), action.flatten(), log.flatten()
    advantage = advantage.flatten()
    for _ in range(EPOCHS):
        for rows in torch.randperm(len(log)).chunk(MINIBATCHES):
            new, entropy, judged = agent.judge(observation[rows], action[rows])
            ratio, gain = (new - log[rows]).exp(), advantage[rows]
            gain = (gain - gain.mean()) / (gain.std() + 1e-8)
            actor = -torch.min(ratio * gain, ratio.clamp(1 - CLIP, 1 + CLIP) * gain).mean()
            critic = 0.5 * (judged - target[rows]).square().mean()
            adam.zero_grad()
            (actor + 0.5 * critic - ENTROPY * entropy.mean()).backward()
            nn.utils.clip_grad_norm_(agent.parameters(), 0.5)
            adam.step()


if __name__ == "__main__":
    main()
