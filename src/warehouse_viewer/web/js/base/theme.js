// SPDX-License-Identifier: Apache-2.0
// Before anything is drawn, so that nothing flashes: what was chosen here last, or the system's, which
// may change, as another tab may choose.
{
  const light = matchMedia('(prefers-color-scheme: light)');
  const dress = () => {
    document.documentElement.dataset.theme = localStorage.getItem('theme') || (light.matches ? 'light' : 'dark');
  };
  dress();
  light.addEventListener('change', dress);
  addEventListener('storage', dress);
}
// Removes the token from the address of a visitor that has been let in: it should not stay there.
if (location.hash.startsWith('#token=')) history.replaceState(null, '', location.pathname);
