#!/usr/bin/env python3
"""The update of tests/bench/update.cc by PyTorch, on one thread, with batches ready in memory. First tries every way
that may be the fastest, each for so many seconds, and prints the name of the fastest. Then reads a number of updates a
line, makes them, and answers with "done".

    pytorch_update.py SECONDS
"""
import itertools
import sys
import time

import torch

BATCH, INPUTS, HIDDEN, ACTIONS, BATCHES = 200, 7, (200, 256), 20, 16


def network():
    return torch.nn.Sequential(torch.nn.Linear(INPUTS, HIDDEN[0]), torch.nn.ReLU(),
                               torch.nn.Linear(HIDDEN[0], HIDDEN[1]), torch.nn.ReLU(),
                               torch.nn.Linear(HIDDEN[1], ACTIONS))


def batches():
    """Observations, next observations, actions, rewards, 1 unless the episode ended, forbidden actions in s'."""
    for _ in range(BATCHES):
        forbidden = torch.rand(BATCH, ACTIONS) < 0.5
        forbidden[:, 0] = False
        yield (torch.rand(BATCH, INPUTS), torch.rand(BATCH, INPUTS), torch.randint(ACTIONS, (BATCH, 1)),
               -torch.rand(BATCH), (torch.rand(BATCH) > 1 / 69).float(), forbidden)


def literal_adam(parameters, beta1=0.9, beta2=0.999, epsilon=1e-8):
    """Adam over one flat vector: as few operations as PyTorch allows. Returns a function that makes a step."""
    moments = [torch.zeros_like(parameters) for _ in range(2)]
    count = itertools.count(1)

    @torch.no_grad()
    def step(learning_rate=1e-4):
        t = next(count)
        gradient = parameters.grad
        moments[0].lerp_(gradient, 1 - beta1)
        moments[1].mul_(beta2).addcmul_(gradient, gradient, value=1 - beta2)
        scale = (moments[1].sqrt() / (1 - beta2 ** t) ** 0.5).add_(epsilon)
        parameters.addcdiv_(moments[0], scale, value=-learning_rate / (1 - beta1 ** t))
    return step


def flatten(module):
    """Makes all parameters, and their gradients, views of one flat vector."""
    flat = torch.nn.utils.parameters_to_vector(module.parameters()).detach().clone()
    flat.grad = torch.zeros_like(flat)
    begin = 0
    for parameter in module.parameters():
        end = begin + parameter.numel()
        parameter.data = flat[begin:end].view_as(parameter)
        parameter.grad = flat.grad[begin:end].view_as(parameter)
        begin = end
    return flat


def make(adam, scripted):
    """A function that makes one update."""
    torch.manual_seed(1)
    current, target = network(), network()
    ready = itertools.cycle(list(batches()))
    flat = flatten(current) if adam == "flat" else None
    if flat is not None:
        step = literal_adam(flat)
    else:
        optimizer = torch.optim.Adam(current.parameters(), lr=1e-4, **({} if adam == "default" else {adam: True}))
        step = optimizer.step
    parameters = list(current.parameters())
    if scripted:
        example = torch.rand(BATCH, INPUTS)
        current, target = torch.jit.script(current), torch.jit.freeze(torch.jit.script(target.eval()))
        target(example)

    def update():
        observations, next_observations, actions, rewards, goes_on, forbidden = next(ready)
        with torch.inference_mode():
            values = target(next_observations).masked_fill_(forbidden, -torch.inf).amax(1)
            targets = torch.addcmul(rewards, goes_on, values)
        if flat is not None:
            flat.grad.zero_()
        else:
            for parameter in parameters:
                parameter.grad = None
        chosen = current(observations).gather(1, actions).squeeze(1)
        torch.nn.functional.mse_loss(chosen, targets.clone()).backward()  # a clone: autograd takes no inference tensor
        step()
    return update


def updates_per_s(update, seconds):
    begin, count = time.perf_counter(), 0
    while time.perf_counter() < begin + seconds:
        update()
        count += 1
    return count / (time.perf_counter() - begin)


def main():
    torch.set_num_threads(1)
    torch.set_flush_denormal(True)
    seconds = float(sys.argv[1])
    found = []
    for adam, scripted, onednn in itertools.product(("default", "foreach", "fused", "flat"), (False, True),
                                                    (False, True)):
        name = f"Adam {adam}, {'scripted' if scripted else 'not scripted'}, oneDNN {'on' if onednn else 'off'}"
        try:
            torch.backends.mkldnn.set_flags(onednn)
            update = make(adam, scripted)
            for _ in range(5):
                update()
            found.append((max(updates_per_s(update, seconds / 5) for _ in range(5)), name, update, onednn))
        except (RuntimeError, TypeError):  # this version of PyTorch does not have it
            continue
    _, name, update, onednn = max(found, key=lambda each: each[0])
    torch.backends.mkldnn.set_flags(onednn)
    print(f"{torch.__version__}, {name}", flush=True)
    for line in sys.stdin:
        for _ in range(int(line)):
            update()
        print("done", flush=True)


if __name__ == "__main__":
    main()
