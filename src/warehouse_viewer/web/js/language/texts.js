// SPDX-License-Identifier: Apache-2.0
// The pages' texts in the language of the person before the browser. A text is looked up by what it is
// in English: ../../texts/en.json lists them all, and a file beside it has another language's. What a
// language lacks is shown in English. All modules wait for the language's file, so a text is never late.

/** Languages with a file in web/texts, but English, which needs none. */
const LANGUAGES = [];
const WORDING = /^[a-z]{2,3}(-[A-Za-z0-9]+)*$/;
const ATTRIBUTES = ['title', 'placeholder', 'aria-label', 'aria-roledescription', 'label'];
const LETTERS = /\p{L}{2}/u;

/** What ?lang= asks for, which is kept for the tab; else the first of the browser's that there is. */
function chosen() {
  const asked = new URLSearchParams(globalThis.location?.search).get('lang') ?? globalThis.sessionStorage?.getItem('lang');
  if (asked && WORDING.test(asked)) {
    globalThis.sessionStorage?.setItem('lang', asked);
    return asked;
  }
  const known = ['en', ...LANGUAGES];
  return (globalThis.navigator?.languages ?? []).map((language) => language.split('-')[0]).find((language) => known.includes(language)) ?? 'en';
}

/** {English: text} of a language, where a text with a number is {one, other, …}. */
async function textsOf(language) {
  if (language === 'en') return {};
  const answer = await fetch(`/web/texts/${language}.json`).catch(() => null);
  return answer?.ok ? answer.json() : {};
}

const language = globalThis.document ? chosen() : 'en'; // tests of a page's sums have no page
const texts = await textsOf(language);
const isEnglish = Object.keys(texts).length === 0;
const rules = new Intl.PluralRules(isEnglish ? 'en' : language);

/** The tag of a text: tr`${done} of ${total} counted` is looked up as '{1} of {2} counted'. */
export function tr(english, ...values) {
  const text = !isEnglish && texts[english.reduce((key, part, i) => `${key}{${i}}${part}`)];
  if (typeof text !== 'string') return english.reduce((all, part, i) => `${all}${values[i - 1]}${part}`);
  return text.replaceAll(/\{(\d+)\}/g, (_, place) => values[place - 1]);
}

/** A text with a count: plural(n, '{n} order', '{n} orders'), looked up by the last. */
export function plural(count, one, other) {
  const forms = texts[other] ?? { one, other };
  return (forms[rules.select(count)] ?? forms.other).replace('{n}', Number(count).toLocaleString());
}

const sameSpaces = (text) => text.trim().replaceAll(/\s+/g, ' ');

/** Puts an element's texts, as its page's file has them, into the language. */
function translate(root) {
  const walker = document.createTreeWalker(root, NodeFilter.SHOW_ELEMENT | NodeFilter.SHOW_TEXT, (node) => (
    node.nodeName === 'SCRIPT' || node.translate === false ? NodeFilter.FILTER_REJECT : NodeFilter.FILTER_ACCEPT));
  while (walker.nextNode()) {
    const node = walker.currentNode;
    if (node.nodeType === Node.TEXT_NODE) translateText(node);
    else for (const name of ATTRIBUTES) translateAttribute(node, name);
  }
}

function translateText(node) {
  if (!LETTERS.test(node.data)) return;
  const [before, after] = [/^\s*/, /\s*$/].map((space) => space.exec(node.data)[0]);
  const text = texts[sameSpaces(node.data)];
  if (typeof text === 'string') node.data = before + text + after;
}

function translateAttribute(element, name) {
  const text = texts[sameSpaces(element.getAttribute(name) ?? '')];
  if (typeof text === 'string') element.setAttribute(name, text);
}

if (!isEnglish) {
  document.documentElement.lang = language;
  translate(document.documentElement);
}
